#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose record FILE`: writes what is said over LCM to a log.
void add_record_command(CLI::App& app);

}  // namespace edgepose
