#include "evaluation/study.h"

#include <optional>
#include <stdexcept>

#include "evaluation/statistics.h"

namespace edgepose {
namespace {

bool same_training(const TrainOptions& a, const TrainOptions& b) {
  return a.sampling_step == b.sampling_step && a.distance_step == b.distance_step &&
         a.angle_step_deg == b.angle_step_deg && a.min_normal_angle_deg == b.min_normal_angle_deg &&
         a.max_normal_angle_deg == b.max_normal_angle_deg && a.visibility_filter == b.visibility_filter &&
         a.views == b.views && a.find_symmetries == b.find_symmetries && a.seed == b.seed;
}

VariantResult summarise(const TestSet& set, const PoseErrors& errors, const Evaluation& evaluation) {
  VariantResult result;
  result.scores = score_results(set, errors, evaluation.rows);
  std::vector<double> verification;
  for (const EvalRow& row : evaluation.rows) verification.push_back(row.stages.verification);
  result.verification_seconds = mean(verification);
  result.seconds = result.scores.time.mean;
  return result;
}

}  // namespace

std::vector<VariantResult> run_experiment(const TestSet& set, const PoseErrors& errors,
                                          const Experiment& experiment, const Progress& progress) {
  std::vector<VariantResult> results;
  std::vector<TrainedModel> models;
  std::optional<TrainOptions> trained;
  const double count = static_cast<double>(experiment.variants.size());
  for (const Variant& variant : experiment.variants) {
    if (!trained || !same_training(*trained, variant.options.train)) {
      models.clear();  // two sets of tables at once would double the memory
      models = train_models(set, variant.options);
      trained = variant.options.train;
    }
    const double done = static_cast<double>(results.size());
    const Evaluation evaluation = run_evaluation(set, models, variant.options, [&](double share) {
      if (progress) progress((done + share) / count);
    });
    results.push_back(summarise(set, errors, evaluation));
  }
  if (progress) progress(1);
  return results;
}

}  // namespace edgepose
