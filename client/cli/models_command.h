#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose models list|show|add|remove|activate|deactivate`: the models that the daemon looks for.
void add_models_command(CLI::App& app);

}  // namespace edgepose
