#pragma once
#include <filesystem>
#include <functional>

#include "server/service_options.h"

namespace edgepose {

/// Runs the daemon until SIGTERM, SIGINT or a command ends it: models loaded, sockets open, then ready.
/// SIGHUP takes what `read_again` gives (it throws InputError for a broken file) instead of `options`. Must
/// be called while the process has one thread. Throws InputError if it cannot start.
void run_service(const ServiceOptions& options, const std::filesystem::path& config,
                 const std::function<ServiceOptions()>& read_again);

}  // namespace edgepose
