#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose eval SET`: trains the models of a test set, finds them in its images and scores the poses.
void add_eval_command(CLI::App& app);

}  // namespace edgepose
