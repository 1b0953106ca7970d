#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose match MODEL... --depth D --intrinsics K`: finds models in a depth image or cloud.
void add_match_command(CLI::App& app);

}  // namespace edgepose
