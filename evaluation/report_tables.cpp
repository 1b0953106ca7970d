#include <algorithm>
#include <map>

#include "evaluation/report.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose {
namespace {

std::string heading_at(double threshold) {
  return std::string("RR at ").append(fixed(threshold, 2)).append(" d, %");
}

void add_recall(Table& table, const std::string& name, const std::string& measure, const Recall& recall) {
  std::vector<std::string> cells = {name, measure, count_text(recall.instances)};
  for (size_t k = 0; k < kThresholds.size(); ++k) cells.push_back(percent(recall.rate(k)));
  table.add(cells);
}

std::vector<std::string> recall_header(const std::string& first) {
  std::vector<std::string> header = {first, "error", "instances"};
  for (double threshold : kThresholds) header.push_back(heading_at(threshold));
  return header;
}

std::string recall_table(const EvalReport& report) {
  Table table(recall_header("object"));
  for (const TestObject& object : report.set.objects) {
    const auto recall = report.scores.objects.find(object.id);
    if (recall == report.scores.objects.end()) continue;
    add_recall(table, harmless_text(object.name), object.symmetric ? "ADI'" : "ADD", recall->second);
  }
  std::vector<std::string> means = {"MR, mean of the objects", "",
                                    count_text(report.scores.pooled.instances)};
  for (double rate : report.scores.mean_recall) means.push_back(percent(rate));
  table.add(means);
  add_recall(table, "MR, all instances pooled", "", report.scores.pooled);
  return table.markdown();
}

std::string group_table(const EvalReport& report) {
  Table table(recall_header(std::string("image number mod ").append(std::to_string(report.group_modulo))));
  const auto groups = recall_by_image_modulo(report.scores, report.group_modulo);
  for (size_t i = 0; i < groups.size(); ++i) add_recall(table, std::to_string(i), "", groups[i]);
  return table.markdown();
}

std::string share_of(size_t part, size_t whole) {
  std::string text = count_text(part) + " of " + count_text(whole);
  if (whole)
    text.append(" (").append(percent(static_cast<double>(part) / static_cast<double>(whole))).append(" %)");
  return text;
}

std::string figures_table(const EvalReport& report) {
  const Scores& scores = report.scores;
  const Evaluation& run = report.evaluation;
  const double questions = static_cast<double>(std::max<size_t>(1, run.rows.size()));
  Table table({"figure", "value"});
  if (report.all_models)
    table.add(
        {"false positives: absent objects reported", share_of(scores.false_positives, scores.absent_pairs)});
  else
    table.add({"false positives", "not asked (only with --all-models)"});
  for (size_t k = 1; k < kThresholds.size(); ++k)
    table.add(
        {std::string("accepted, of the poses correct at ").append(fixed(kThresholds[k], 2)).append(" d"),
         share_of(scores.best_guesses.correct_accepted[k], scores.best_guesses.correct[k])});
  table.add({"median error of the poses correct at 0.05 d, mm", fixed(1e3 * scores.median_error, 3)});
  table.add({"the same, ADD of objects without symmetries, mm", fixed(1e3 * scores.median_add, 3)});
  table.add({"time for an object in an image: median, ms", milliseconds(scores.time.median)});
  table.add({"... mean, ms", milliseconds(scores.time.mean)});
  table.add({"... 95th percentile, ms", milliseconds(scores.time.p95)});
  table.add({"CPU time for an object in an image: mean, ms", milliseconds(run.cpu_seconds / questions)});
  table.add({"questions asked", count_text(run.rows.size())});
  const auto cut_short =
      std::count_if(run.rows.begin(), run.rows.end(), [](const EvalRow& row) { return row.cut_short; });
  if (cut_short > 0)
    table.add({"searches ended by the deadline", share_of(static_cast<size_t>(cut_short), run.rows.size())});
  table.add({"wall time of all, s", fixed(run.wall_seconds, 2)});
  table.add({"CPU time of all, s", fixed(run.cpu_seconds, 2)});
  table.add({"peak memory, MB", fixed(run.peak_memory_megabytes, 0)});
  return table.markdown();
}

std::string stage_table(const EvalReport& report) {
  Table table({"stage", "median, ms", "mean, ms", "share of the mean, %"});
  const auto& rows = report.evaluation.rows;
  std::vector<double> all;
  all.reserve(rows.size());
  for (const EvalRow& row : rows) all.push_back(row.seconds);
  const auto add = [&](const char* name, auto&& time_of) {
    std::vector<double> times;
    times.reserve(rows.size());
    for (const EvalRow& row : rows) times.push_back(time_of(row));
    const double total = mean(all);
    table.add({name, milliseconds(median(times)), milliseconds(mean(times)),
               fixed(total > 0 ? 100 * mean(times) / total : 0, 1)});
  };
  add("preprocessing (its share)", [](const EvalRow& r) { return r.preprocessing; });
  add("sampling", [](const EvalRow& r) { return r.stages.sampling; });
  add("voting", [](const EvalRow& r) { return r.stages.voting; });
  add("clustering", [](const EvalRow& r) { return r.stages.clustering; });
  add("verification", [](const EvalRow& r) { return r.stages.verification; });
  add("refinement", [](const EvalRow& r) { return r.stages.refinement; });
  add("all", [](const EvalRow& r) { return r.seconds; });
  return table.markdown();
}

std::string training_table(const EvalReport& report) {
  Table table({"model", "diameter, mm", "points", "pairs", "table, MB", "training, s"});
  std::map<int, std::string> names;
  for (const TestObject& object : report.set.objects) names[object.id] = harmless_text(object.name);
  for (const TrainingFacts& model : report.models)
    table.add({names[model.object_id], fixed(1e3 * model.diameter, 1), count_text(model.points),
               count_text(model.pairs), fixed(static_cast<double>(model.bytes) / 1e6, 1),
               fixed(model.seconds, 2)});
  return table.markdown();
}

}  // namespace

std::string result_tables(const EvalReport& report) {
  std::string text = "## Recall\n\n" + recall_table(report);
  if (report.all_models) text += "\nOnly accepted poses count, as in the result file.\n";
  if (report.group_modulo > 0) text.append("\n").append(group_table(report));
  text += "\n## Figures\n\n" + figures_table(report) + "\n## Time by stage\n\n" + stage_table(report) +
          "\n## Training\n\n" + training_table(report);
  return text;
}

}  // namespace edgepose
