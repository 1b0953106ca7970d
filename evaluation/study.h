#pragma once
#include <string>
#include <vector>

#include "evaluation/evaluate.h"
#include "evaluation/plot.h"
#include "evaluation/score.h"

namespace edgepose {

/// One way of running the matcher over the set.
struct Variant {
  std::string method;   ///< "edge score S (paper)"
  std::string setting;  ///< what varies within the method: "1.5 mm"; may be empty
  double value = 0;     ///< the same as a number, for plots
  EvalOptions options;
};

/// One of the paper's experiments.
struct Experiment {
  enum class Layout {
    kBySetting,  ///< a row for each method and threshold, a column for each setting (Table "noise")
    kByObject,   ///< a row for each method and threshold, a column for each object or group (ablation tables)
    kByTime,     ///< a row for each method: times and recall (figure of the three ways)
    kSweep,      ///< a row for each setting, a plot over it (parameter analysis)
  };
  std::string key, title, note;
  std::string setting_label;  ///< of the varied setting, with its unit
  Layout layout = Layout::kByObject;
  std::vector<Variant> variants;
};

/// What came out of one variant.
struct VariantResult {
  Scores scores;
  double verification_seconds = 0;  ///< mean of an object in an image
  double seconds = 0;               ///< mean, everything included
};

/// Tables and plots of one experiment.
struct StudySection {
  std::string markdown;
  std::vector<Plot> plots;
};

/// "noise", "sampling", "verification", "early-exit", "sweep": the names that experiments() knows.
const std::vector<std::string>& experiment_names();

/// The paper's experiments of that name (a sweep is several), built on `base`. Throws InputError if unknown.
std::vector<Experiment> experiments(const std::string& name, const EvalOptions& base);

/// Runs every variant; models are trained again only where the training options differ.
std::vector<VariantResult> run_experiment(const TestSet& set, const PoseErrors& errors,
                                          const Experiment& experiment, const Progress& progress = {});

/// `group_modulo` > 0: columns are image numbers modulo this (S1, S2, S3 of a spine set) instead of objects.
StudySection describe(const TestSet& set, const Experiment& experiment,
                      const std::vector<VariantResult>& results, int group_modulo);

}  // namespace edgepose
