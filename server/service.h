#pragma once
#include <filesystem>

#include "server/service_options.h"

namespace edgepose {

/// Runs the daemon until SIGTERM, SIGINT or a command ends it: models loaded, sockets open, then ready.
/// SIGHUP reads `config` again. Must be called while the process has one thread. Throws InputError if it
/// cannot start.
void run_service(ServiceOptions options, const std::filesystem::path& config);

}  // namespace edgepose
