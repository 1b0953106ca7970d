#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace edgepose {

/// A finite number from `low` to `high`; unlike CLI::Range it refuses "nan".
CLI::Validator number_between(double low, double high);

/// An option that names a file or folder to write: an empty name is refused, not taken for none.
CLI::Option* add_output_option(CLI::App& command, const std::string& names, std::filesystem::path& path,
                               const std::string& description);

}  // namespace edgepose
