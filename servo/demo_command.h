#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// edgepose-servo demo: service, simulator and controller in one command, to a report.
void add_demo_command(CLI::App& app);

}  // namespace edgepose
