#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose info FILE`: what a trained model holds, or how sound a mesh is.
void add_info_command(CLI::App& app);

}  // namespace edgepose
