#pragma once
#include <CLI/CLI.hpp>

namespace edgepose {

/// `edgepose keygen FILE`: makes a secret key that the daemon and its clients share.
void add_keygen_command(CLI::App& app);

}  // namespace edgepose
