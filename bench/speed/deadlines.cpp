#include <array>
#include <cmath>
#include <limits>

#include "bench/speed/parts.h"
#include "bench/speed/samples.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose::bench {
namespace {

constexpr double kNoDeadline = std::numeric_limits<double>::infinity();
constexpr std::array<double, 11> kDeadlines = {0.005, 0.010, 0.015, 0.020, 0.030,      0.050,
                                               0.075, 0.100, 0.150, 0.200, kNoDeadline};  // [s]

/// All that was answered with one deadline.
struct Tally {
  std::vector<std::vector<EvalRow>> repeats;  ///< each is an evaluation of its own
  size_t asked = 0, cut_short = 0, late = 0;

  void add(size_t questions, EvalRow row, double deadline) {
    if (repeats.empty() || repeats.back().size() == questions) repeats.emplace_back();
    ++asked;
    cut_short += row.cut_short;
    late += row.seconds > deadline;
    repeats.back().push_back(std::move(row));
  }
};

}  // namespace

std::string time_deadlines(SpeedRun& run) {
  Samples samples(kDeadlines.size(), run.questions.size());
  std::vector<Tally> tallies(kDeadlines.size());
  take_turns(
      kDeadlines.size(), run.questions.size(), run.repeat,
      [&](size_t v, size_t q) {
        const Question& question = run.questions[q];
        const double deadline = std::isinf(kDeadlines[v]) ? 0 : kDeadlines[v];
        return ask(run.images[question.image], run.models[question.model].model, {{}, run.threads, deadline});
      },
      [&](size_t v, size_t q, const Answer& answer) {
        samples.add(v, q, answer.seconds());
        tallies[v].add(run.questions.size(), row_of(run, run.questions[q], answer), kDeadlines[v]);
      });

  Table table({"deadline, ms", "correct at 0.05 d, %", "at 0.10 d, %", "time: median, ms", "p99, ms",
               "worst, ms", "late, %", "cut short, %"});
  for (size_t v = 0; v < kDeadlines.size(); ++v) {
    Recall recall;
    for (const std::vector<EvalRow>& rows : tallies[v].repeats) {
      const Recall once = recall_of(run, rows);
      recall.instances += once.instances;
      for (size_t k = 0; k < kThresholds.size(); ++k) recall.correct[k] += once.correct[k];
    }
    const std::vector<double> seconds = samples.all(v);
    const double asked = static_cast<double>(tallies[v].asked);
    CurvePoint point{.curve = "deadline", .variant = "", .x = kDeadlines[v]};
    point.median = median(seconds);
    point.p99 = percentile(seconds, 0.99);
    point.correct_005 = recall.rate(1);
    point.correct_010 = recall.rate(2);
    table.add({std::isinf(kDeadlines[v]) ? "none" : fixed(1e3 * kDeadlines[v], 0), percent(point.correct_005),
               percent(point.correct_010), milliseconds(point.median), milliseconds(point.p99),
               milliseconds(percentile(seconds, 1)),
               fixed(100 * static_cast<double>(tallies[v].late) / asked, 1),
               fixed(100 * static_cast<double>(tallies[v].cut_short) / asked, 1)});
    run.curves.add(point);
  }
  return "## Recall over the deadline\n\n" + table.markdown() +
         "\nOne object in one image, preprocessing in full and within the deadline. Every answer counts by "
         "itself, also those that are not accepted, as in `edgepose eval`.\n";
}

}  // namespace edgepose::bench
