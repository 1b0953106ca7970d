#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose study SET`: the paper's own experiments on a test set, as tables and plots.
void add_study_command(CLI::App& app);

}  // namespace edgepose
