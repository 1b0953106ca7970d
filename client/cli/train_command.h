#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose train MESH -o MODEL`: trains a model and saves it.
void add_train_command(CLI::App& app);

}  // namespace edgepose
