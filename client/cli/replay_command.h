#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose replay LOG`: sends the frames of a log once more.
void add_replay_command(CLI::App& app);

}  // namespace edgepose
