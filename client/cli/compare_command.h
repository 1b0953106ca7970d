#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose compare A B`: compares the poses in a log with those in another, or with the truth.
void add_compare_command(CLI::App& app);

}  // namespace edgepose
