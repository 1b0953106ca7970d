#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// edgepose-servo arm, go, stop, reset, homed, status: what tells a running controller what to do.
void add_client_commands(CLI::App& app);

}  // namespace edgepose
