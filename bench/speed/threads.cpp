#include <algorithm>
#include <thread>

#include "bench/speed/parts.h"
#include "bench/speed/samples.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose::bench {
namespace {

/// Each number up to 8, powers of two beyond, and `most` itself.
std::vector<int> thread_counts(int most) {
  if (most <= 0) most = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<int> counts;
  for (int count = 1; count < most; count = count < 8 ? count + 1 : 2 * count) counts.push_back(count);
  counts.push_back(most);
  return counts;
}

}  // namespace

std::string time_threads(SpeedRun& run) {
  const std::vector<int> counts = thread_counts(run.max_threads);
  Samples preprocessing(counts.size(), run.questions.size()), matching = preprocessing, all = preprocessing;
  take_turns(
      counts.size(), run.questions.size(), run.repeat,
      [&](size_t v, size_t q) {
        const Question& question = run.questions[q];
        return ask(run.images[question.image], run.models[question.model].model, {{}, counts[v], 0});
      },
      [&](size_t v, size_t q, const Answer& answer) {
        preprocessing.add(v, q, answer.preprocessing);
        matching.add(v, q, answer.matching);
        all.add(v, q, answer.seconds());
      });

  Table table({"threads", "preprocessing, median, ms", "match(), median, ms", "all, median, ms",
               "all, p99, ms", "times as fast as one"});
  const double alone = median(all.typical(0));
  for (size_t v = 0; v < counts.size(); ++v) {
    const double x = counts[v];
    const auto add = [&](const char* variant, const std::vector<double>& seconds) {
      run.curves.add({.curve = "threads",
                      .variant = variant,
                      .x = x,
                      .median = median(seconds),
                      .p99 = percentile(seconds, 0.99)});
    };
    add("preprocessing", preprocessing.typical(v));
    add("all", all.typical(v));
    const double middle = median(all.typical(v));
    table.add({std::to_string(counts[v]), milliseconds(median(preprocessing.typical(v))),
               milliseconds(median(matching.typical(v))), milliseconds(middle),
               milliseconds(percentile(all.typical(v), 0.99)), fixed(middle > 0 ? alone / middle : 0, 2)});
  }
  return "## Cost over threads\n\n" + table.markdown() +
         "\nOne object in one image, preprocessing in full; " +
         count_text(std::thread::hardware_concurrency()) + " processors.\n";
}

}  // namespace edgepose::bench
