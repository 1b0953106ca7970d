#pragma once
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "experiment/trial.h"

namespace edgepose {

/// The rows of the table: A, B, C, D1 and D5 under the paper's noise, C without noise, D5 with a touch that
/// is off by 0.3 mm and 0.1 degrees.
std::vector<ExperimentArm> standard_arms();

struct ExperimentOptions {
  std::vector<ExperimentArm> arms = standard_arms();
  int trials = 200;  ///< of each arm, seeds first_seed and on
  uint64_t first_seed = 1;
  int threads = 0;  ///< trials at once; 0: all cores. The result does not depend on it
  TrialOptions trial;

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// The results of one row, by seed.
struct ArmResults {
  ExperimentArm arm;
  std::vector<TrialResult> trials;
};

/// Runs all trials that are not yet in `done` and returns all. `note` is called after each one, from any
/// thread but never at once, with all that is known of it. A stop leaves the rest out. Throws what a trial
/// throws.
using TrialNote = std::function<void(const ExperimentArm& arm, const TrialResult& result)>;
std::vector<ArmResults> run_experiment(const WorkCell& cell, const ExperimentOptions& options,
                                       std::vector<ArmResults> done, const TrialNote& note,
                                       const std::stop_token& stop);

/// Trials as CSV, one line each, so that an experiment that was cut short goes on where it was. `made_with`:
/// one line that must be the same then.
std::string trial_line(const ExperimentArm& arm, const TrialResult& result);
/// The results in `path`; none if there is no such file. Lines of other arms are left out, and what is no
/// line (half a line at the end) as well. Throws InputError if it is no such file, or made with something
/// else.
std::vector<ArmResults> read_trials(const std::filesystem::path& path, const std::string& made_with,
                                    const std::vector<ExperimentArm>& arms);
std::string trial_heading(const std::string& made_with);

}  // namespace edgepose
