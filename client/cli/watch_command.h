#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose watch`: shows the answers of the service as they come.
void add_watch_command(CLI::App& app);

}  // namespace edgepose
