#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose send PATH...`: plays a depth camera: sends depth images over LCM.
void add_send_command(CLI::App& app);

}  // namespace edgepose
