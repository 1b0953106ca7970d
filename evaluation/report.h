#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "common/atomic_file.h"
#include "evaluation/evaluate.h"
#include "evaluation/plot.h"
#include "evaluation/score.h"

namespace edgepose {

/// All that a report tells of one run.
struct EvalReport {
  const TestSet& set;
  bool all_models = false;  ///< was asked for every model in every image
  const std::vector<TrainingFacts>& models;
  const Evaluation& evaluation;
  const Scores& scores;
  int group_modulo = 0;  ///< recall by image number modulo this; 0 = none
  std::string command;   ///< that reproduces the run
};

/// Recall, false positives, accuracy, times and training as Markdown that reads well on a terminal.
std::string result_tables(const EvalReport& report);

/// The plots of a run: recall by object, by threshold and by visibility; errors; times; shares of the stages.
std::vector<Plot> result_plots(const EvalReport& report);

/// Draws `plots` into `folder` (made if missing); they appear when `files` are committed. Returns Markdown
/// that shows them, or, if gnuplot is missing, says so; that is then also the one line in `warning`. Throws
/// InputError if the folder cannot be written.
std::string draw_all(const std::vector<Plot>& plots, const std::filesystem::path& folder, FileGroup& files,
                     std::string& warning);

/// Writes FOLDER/report.md and its plots, all or nothing. Returns a warning (one line), or nothing. Throws
/// InputError.
std::string write_report(const EvalReport& report, const std::filesystem::path& folder);

}  // namespace edgepose
