#include <array>

#include "bench/speed/parts.h"
#include "bench/speed/samples.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose::bench {
namespace {

constexpr std::array<float, 7> kSteps = {0.03f, 0.035f, 0.04f, 0.05f, 0.06f, 0.08f, 0.1f};  // [d]

/// The set's objects, trained with that step.
std::vector<TrainedModel> trained_with_step(const SpeedRun& run, float step) {
  EvalOptions options;
  options.threads = run.threads;
  options.train.sampling_step = step;
  return train_models(run.set, options);
}

/// Medians over the models.
struct ModelSizes {
  double points = 0, pairs = 0, megabytes = 0;
};

ModelSizes sizes_of(const std::vector<TrainedModel>& models) {
  std::vector<double> points, pairs, megabytes;
  for (const TrainedModel& model : models) {
    points.push_back(static_cast<double>(model.model.point_count()));
    pairs.push_back(static_cast<double>(model.model.pair_count()));
    megabytes.push_back(1e-6 * static_cast<double>(model.model.block().size()));
  }
  return {median(points), median(pairs), median(megabytes)};
}

}  // namespace

std::string time_model_points(SpeedRun& run) {
  std::vector<std::vector<TrainedModel>> models;
  for (const float step : kSteps) models.push_back(trained_with_step(run, step));
  Samples matching(kSteps.size(), run.questions.size());
  std::vector<std::vector<double>> scene_points(kSteps.size());
  std::vector<std::vector<EvalRow>> rows(kSteps.size());
  take_turns(
      kSteps.size(), run.questions.size(), run.repeat,
      [&](size_t v, size_t q) {
        const Question& question = run.questions[q];
        return ask(run.images[question.image], models[v][question.model].model, {{}, run.threads, 0});
      },
      [&](size_t v, size_t q, const Answer& answer) {
        matching.add(v, q, answer.matching);
        scene_points[v].push_back(static_cast<double>(answer.result.scene_points));
        if (rows[v].size() < run.questions.size()) rows[v].push_back(row_of(run, run.questions[q], answer));
      });

  Table table({"sampling_step, d", "model points", "pairs", "model, MB", "scene points", "median, ms",
               "p99, ms", "correct at 0.05 d, %"});
  for (size_t v = 0; v < kSteps.size(); ++v) {
    const ModelSizes sizes = sizes_of(models[v]);
    const std::vector<double> seconds = matching.typical(v);
    const Recall recall = recall_of(run, rows[v]);
    CurvePoint point{.curve = "model_points", .variant = "", .x = sizes.points};
    point.median = median(seconds);
    point.p99 = percentile(seconds, 0.99);
    point.correct_005 = recall.rate(1);
    point.correct_010 = recall.rate(2);
    table.add({fixed(static_cast<double>(kSteps[v]), 3), fixed(sizes.points, 0), fixed(sizes.pairs, 0),
               fixed(sizes.megabytes, 2), fixed(median(scene_points[v]), 0), milliseconds(point.median),
               milliseconds(point.p99), percent(point.correct_005)});
    run.curves.add(point);
  }
  return "## Cost over model points\n\n" + table.markdown() +
         "\nmatch() without preprocessing; train.sampling_step varies, and the scene is sampled about as "
         "finely "
         "as the model, in steps of a quarter of an octave. Sizes are medians over the models.\n";
}

}  // namespace edgepose::bench
