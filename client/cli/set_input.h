#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluate.h"

namespace edgepose {

/// What `eval` and `study` have in common: the test set, which part of it, and the options of the matcher.
struct SetInput {
  std::filesystem::path folder, config;
  std::vector<std::string> objects;
  std::string images;
  std::optional<int> threads;

  void add_options(CLI::App& command);
  TestSet read() const;         ///< the part that is wanted; throws InputError
  EvalOptions options() const;  ///< defaults, or those of --config; throws InputError
  std::vector<std::filesystem::path> files(const TestSet& set) const;  ///< that are read
  std::string command_line() const;  ///< "SET --objects ..." that gives the same part
};

/// `command` with what it takes to run it again; single quotes where the shell needs them.
std::string shell_quoted(const std::string& argument);

}  // namespace edgepose
