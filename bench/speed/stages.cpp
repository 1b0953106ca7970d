#include <array>

#include "bench/speed/parts.h"
#include "bench/speed/samples.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose::bench {
namespace {

constexpr size_t kStages = 7;
constexpr std::array<const char*, kStages> kStageNames = {
    "preprocessing", "sampling", "voting", "clustering", "verification", "refinement", "all"};

/// In the order of kStageNames. What match() does between its stages is in "all" only.
std::array<double, kStages> stage_seconds(const Answer& answer) {
  const StageTimes& s = answer.result.times;
  return {answer.preprocessing, s.sampling,   s.voting,        s.clustering,
          s.verification,       s.refinement, answer.seconds()};
}

std::string ratio(const std::vector<double>& seconds) {
  const double middle = median(seconds);
  return fixed(middle > 0 ? percentile(seconds, 0.99) / middle : 0, 2);
}

}  // namespace

std::string time_stages(SpeedRun& run) {
  Samples samples(kStages, run.questions.size());
  take_turns(
      1, run.questions.size(), run.repeat,
      [&](size_t, size_t q) {
        const Question& question = run.questions[q];
        return ask(run.images[question.image], run.models[question.model].model, {{}, run.threads, 0});
      },
      [&](size_t, size_t q, const Answer& answer) {
        const auto seconds = stage_seconds(answer);
        for (size_t s = 0; s < kStages; ++s) samples.add(s, q, seconds[s]);
      });

  const double whole = mean(samples.typical(kStages - 1));
  Table table({"stage", "median, ms", "p99, ms", "mean, ms", "share of the mean, %"});
  for (size_t s = 0; s < kStages; ++s) {
    const std::vector<double> seconds = samples.typical(s);
    table.add({kStageNames[s], milliseconds(median(seconds)), milliseconds(percentile(seconds, 0.99)),
               milliseconds(mean(seconds)), fixed(whole > 0 ? 100 * mean(seconds) / whole : 0, 1)});
  }
  const std::vector<double> every = samples.all(kStages - 1);
  return "## Stages of a detection\n\n" + table.markdown() +
         "\nOne object in one image, preprocessing in full; each question's median over its repeats.\n"
         "p99 over median: " +
         ratio(samples.typical(kStages - 1)) + "; of all " + count_text(every.size()) +
         " answers by themselves, the machine's hiccups included: " + ratio(every) + " (median " +
         milliseconds(median(every)) + " ms, p99 " + milliseconds(percentile(every, 0.99)) + " ms).\n";
}

}  // namespace edgepose::bench
