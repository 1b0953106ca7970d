#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose merge SHARD...`: puts the parts of an evaluation together and scores it.
void add_merge_command(CLI::App& app);

}  // namespace edgepose
