#pragma once
#include "controller/controller_options.h"

namespace edgepose {

/// Runs edgepose-servo until SIGTERM, SIGINT or a shutdown command: then the arm comes to rest first. Throws
/// InputError, one line, if it cannot start; nothing has moved then.
void run_controller(const ControllerOptions& options);

}  // namespace edgepose
