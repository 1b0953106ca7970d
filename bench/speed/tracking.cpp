#include <Eigen/Geometry>
#include <array>
#include <numbers>
#include <random>

#include "bench/speed/parts.h"
#include "bench/speed/samples.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"
#include "matcher/stopwatch.h"
#include "matcher/track.h"

namespace edgepose::bench {
namespace {

constexpr float kWindowMargin = 0.2f;  // [d] as tracking.margin of the service

Eigen::Vector3d some_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::Vector3d direction;
  for (double& component : direction) component = normal(random);
  return direction.normalized();
}

/// The true pose, turned about the model's centre and moved, each in a direction by chance.
RigidTransform disturbed(const SpeedRun& run, const Question& question, std::mt19937_64& random) {
  const Eigen::Vector3d centre = run.models[question.model].model.centre();
  RigidTransform pose = question.camera_T_model;
  pose.pretranslate(run.shift * some_direction(random));
  pose.translate(centre);
  pose.rotate(Eigen::AngleAxisd(run.turn, some_direction(random)));
  pose.translate(-centre);
  return pose;
}

}  // namespace

std::string time_tracking(SpeedRun& run) {
  enum : size_t { kTrack, kWhole, kWindow, kStep, kRows };
  std::vector<RigidTransform> starts;
  std::mt19937_64 random(run.seed);
  for (const Question& question : run.questions) starts.push_back(disturbed(run, question, random));

  Samples samples(kRows, run.questions.size());
  std::vector<EvalRow> rows(run.questions.size());
  const auto step = [&](size_t, size_t q) {
    const Question& question = run.questions[q];
    const ImageInput window = cropped(run, question, starts[q], kWindowMargin);
    MatchOptions options;
    options.threads = run.threads;
    std::array<double, kRows> seconds{};
    Stopwatch watch;
    const Scene scene = prepare(run.images[question.image], run.threads);
    seconds[kWhole] = watch.lap();
    Answer answer;
    answer.result = track(scene, run.models[question.model].model, {{starts[q], 1}}, options);
    seconds[kTrack] = watch.lap();
    const Scene part = prepare(window, run.threads);
    seconds[kWindow] = watch.lap();
    track(part, run.models[question.model].model, {{starts[q], 1}}, options);
    seconds[kStep] = seconds[kWindow] + watch.lap();
    rows[q] = row_of(run, question, answer);
    return seconds;
  };
  take_turns(1, run.questions.size(), run.repeat, step,
             [&](size_t, size_t q, const std::array<double, kRows>& seconds) {
               for (size_t row = 0; row < kRows; ++row) samples.add(row, q, seconds[row]);
             });

  Table table({"step", "median, ms", "p99, ms", "p99 over median"});
  const auto add = [&](size_t row, const std::string& name) {
    const std::vector<double> seconds = samples.typical(row);
    const double middle = median(seconds), high = percentile(seconds, 0.99);
    table.add({name, fixed(1e3 * middle, 2), fixed(1e3 * high, 2), fixed(middle > 0 ? high / middle : 0, 2)});
  };
  const DepthImage& image = run.images.front().depth;
  add(kTrack, "track(), scene prepared");
  add(kWhole,
      "preprocessing of the image, " + std::to_string(image.width) + " x " + std::to_string(image.height));
  add(kWindow, "preprocessing of the window around the object");
  add(kStep, "that window, and track() in it");
  const Recall followed = recall_of(run, rows);
  return "## Tracking\n\n" + table.markdown() + "\nFrom poses " + fixed(1e3 * run.shift, 1) + " mm and " +
         fixed(run.turn * 180 / std::numbers::pi, 1) + " degrees off the truth, one object at a time; " +
         count_text(followed.correct[1]) + " of " + count_text(followed.instances) +
         " within 0.05 d after the step. The window is what the object can cover and " +
         fixed(static_cast<double>(kWindowMargin), 1) + " d around it, as the service cuts it out.\n";
}

}  // namespace edgepose::bench
