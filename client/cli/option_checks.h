#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

namespace edgepose {

/// A finite number from `low` to `high`; unlike CLI::Range it refuses "nan".
CLI::Validator number_between(double low, double high);

/// --deadline-ms: [ms] for each model in each image, preprocessing included; `what` completes "Milliseconds
/// for ...". Taken are finite numbers above 0, up to an hour.
CLI::Option* add_deadline_option(CLI::App& command, std::optional<double>& milliseconds,
                                 const std::string& what);

/// An option that names a file or folder to write: an empty name is refused, not taken for none.
CLI::Option* add_output_option(CLI::App& command, const std::string& names, std::filesystem::path& path,
                               const std::string& description);

}  // namespace edgepose
