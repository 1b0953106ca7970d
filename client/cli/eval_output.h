#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/evaluate.h"

namespace edgepose {

/// What becomes of an evaluation's answers, by `eval` and by `merge`: a result file, tables, a report.
struct EvalOutput {
  std::filesystem::path results, report;
  int group_modulo = 0;

  void add_options(CLI::App& command);
  /// Before the work, not after it. `read`: files that must not be replaced. Throws InputError.
  void check(const std::vector<std::filesystem::path>& read) const;
  /// Writes and prints. `command`: that reproduces the run. Throws InputError.
  void write(const TestSet& set, const Evaluation& evaluation, const std::vector<TrainingFacts>& models,
             bool all_models, const std::string& command) const;
};

}  // namespace edgepose
