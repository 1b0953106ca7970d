#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose detect`: has the daemon look for its models in one depth image, or in the last frame.
void add_detect_command(CLI::App& app);

}  // namespace edgepose
