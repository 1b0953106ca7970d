#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose render`: depth images of meshes at given poses, as a sensor would see them.
void add_render_command(CLI::App& app);

}  // namespace edgepose
