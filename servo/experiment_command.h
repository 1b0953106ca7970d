#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// edgepose-servo experiment: many positionings in simulated time, to a table.
void add_experiment_command(CLI::App& app);

}  // namespace edgepose
