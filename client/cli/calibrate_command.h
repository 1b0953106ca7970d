#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose calibrate hand-eye SAMPLES -o FILE`: finds where the camera is on the arm's flange.
void add_calibrate_command(CLI::App& app);

/// `edgepose teach RECORD -o FILE`: learns where the camera sees the tool.
void add_teach_command(CLI::App& app);

}  // namespace edgepose
