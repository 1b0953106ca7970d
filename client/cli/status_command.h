#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose status`: how the daemon is.
void add_status_command(CLI::App& app);

}  // namespace edgepose
