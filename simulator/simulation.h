#pragma once
#include "simulator/simulation_options.h"

namespace edgepose {

/// Runs the simulator in real time until SIGTERM, SIGINT or the command "shutdown". Throws InputError if it
/// cannot start.
void run_simulation(const SimulationOptions& options);

}  // namespace edgepose
