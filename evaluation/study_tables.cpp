#include <algorithm>

#include "evaluation/study.h"
#include "evaluation/table.h"

namespace edgepose {
namespace {

/// The paper's tables show these two.
constexpr std::array<size_t, 2> kShown = {1, 2};
std::string threshold_text(size_t k) { return fixed(kThresholds[k], 2) + " d"; }

std::vector<std::string> methods_of(const Experiment& experiment) {
  std::vector<std::string> methods;
  for (const Variant& variant : experiment.variants)
    if (std::find(methods.begin(), methods.end(), variant.method) == methods.end())
      methods.push_back(variant.method);
  return methods;
}

/// The columns of the ablation tables: groups of images, or objects.
std::vector<std::string> column_names(const TestSet& set, int group_modulo) {
  std::vector<std::string> names;
  if (group_modulo > 0) names.reserve(group_modulo);
  for (int i = 0; i < group_modulo; ++i) names.push_back(std::string("S").append(std::to_string(i + 1)));
  if (group_modulo <= 0)
    for (const TestObject& object : set.objects) names.push_back(harmless_text(object.name));
  return names;
}

std::vector<Recall> column_recalls(const TestSet& set, const Scores& scores, int group_modulo) {
  if (group_modulo > 0) return recall_by_image_modulo(scores, group_modulo);
  std::vector<Recall> recalls;
  for (const TestObject& object : set.objects) {
    const auto recall = scores.objects.find(object.id);
    recalls.push_back(recall == scores.objects.end() ? Recall{} : recall->second);
  }
  return recalls;
}

std::string by_setting(const Experiment& experiment, const std::vector<VariantResult>& results) {
  std::vector<std::string> header = {"method", "at"};
  for (size_t i = 0; i < experiment.variants.size(); ++i)
    if (experiment.variants[i].method == experiment.variants[0].method)
      header.push_back(experiment.variants[i].setting);
  Table table(header);
  for (const std::string& method : methods_of(experiment))
    for (size_t k : kShown) {
      std::vector<std::string> cells = {method, threshold_text(k)};
      for (size_t i = 0; i < results.size(); ++i)
        if (experiment.variants[i].method == method)
          cells.push_back(percent(results[i].scores.pooled.rate(k)));
      table.add(cells);
    }
  return "Recall in %, all instances pooled; columns: " + experiment.setting_label + ".\n\n" +
         table.markdown();
}

std::string by_object(const TestSet& set, const Experiment& experiment,
                      const std::vector<VariantResult>& results, int group_modulo) {
  std::vector<std::string> header = {"method", "at"};
  for (const std::string& name : column_names(set, group_modulo)) header.push_back("RR " + name);
  header.insert(header.end(), {"MR", "pooled", "time, ms"});
  Table table(header);
  for (size_t i = 0; i < results.size(); ++i)
    for (size_t k : kShown) {
      std::vector<std::string> cells = {experiment.variants[i].method, threshold_text(k)};
      for (const Recall& recall : column_recalls(set, results[i].scores, group_modulo))
        cells.push_back(recall.instances ? percent(recall.rate(k)) : "-");
      cells.push_back(percent(results[i].scores.mean_recall[k]));
      cells.push_back(percent(results[i].scores.pooled.rate(k)));
      cells.push_back(milliseconds(results[i].seconds));
      table.add(cells);
    }
  std::string text = "Recall in %.";
  if (group_modulo > 0)
    text += " S1, S2, ...: image number mod " + std::to_string(group_modulo) + " = 0, 1, ...";
  return text + "\n\n" + table.markdown();
}

std::string by_time(const Experiment& experiment, const std::vector<VariantResult>& results) {
  Table table({"way", "verification, ms", "everything, ms", "pooled at 0.05 d, %", "pooled at 0.10 d, %"});
  for (size_t i = 0; i < results.size(); ++i)
    table.add({experiment.variants[i].method, milliseconds(results[i].verification_seconds),
               milliseconds(results[i].seconds), percent(results[i].scores.pooled.rate(1)),
               percent(results[i].scores.pooled.rate(2))});
  return "Mean times of one object in one image.\n\n" + table.markdown();
}

std::string by_sweep(const Experiment& experiment, const std::vector<VariantResult>& results) {
  Table table({experiment.setting_label, "MR at 0.05 d, %", "MR at 0.10 d, %", "pooled at 0.05 d, %",
               "pooled at 0.10 d, %", "time, ms"});
  for (size_t i = 0; i < results.size(); ++i) {
    const Scores& scores = results[i].scores;
    table.add({experiment.variants[i].setting, percent(scores.mean_recall[1]), percent(scores.mean_recall[2]),
               percent(scores.pooled.rate(1)), percent(scores.pooled.rate(2)),
               milliseconds(results[i].seconds)});
  }
  return table.markdown();
}

/// Pooled recall over the varied setting, a curve for each method and threshold.
Plot curves(const Experiment& experiment, const std::vector<VariantResult>& results) {
  Plot plot{.kind = Plot::Kind::kPoints,
            .file = experiment.key,
            .title = experiment.title,
            .x_label = experiment.setting_label,
            .y_label = "recall, pooled, %",
            .y_percent = true};
  for (const std::string& method : methods_of(experiment))
    for (size_t k : kShown) {
      Series series{method.empty() ? threshold_text(k) : method + " " + threshold_text(k), {}, {}};
      for (size_t i = 0; i < results.size(); ++i) {
        if (experiment.variants[i].method != method) continue;
        series.x.push_back(experiment.variants[i].value);
        series.y.push_back(100 * results[i].scores.pooled.rate(k));
      }
      plot.series.push_back(std::move(series));
    }
  return plot;
}

Plot time_curve(const Experiment& experiment, const std::vector<VariantResult>& results) {
  Plot plot{.kind = Plot::Kind::kPoints,
            .file = experiment.key + "_time",
            .title = experiment.title,
            .x_label = experiment.setting_label,
            .y_label = "mean time, ms"};
  Series series{"", {}, {}};
  for (size_t i = 0; i < results.size(); ++i) {
    series.x.push_back(experiment.variants[i].value);
    series.y.push_back(1e3 * results[i].seconds);
  }
  plot.series.push_back(std::move(series));
  return plot;
}

Plot recall_bars(const TestSet& set, const Experiment& experiment, const std::vector<VariantResult>& results,
                 int group_modulo) {
  Plot plot{.kind = Plot::Kind::kBars,
            .file = experiment.key,
            .title = experiment.title + ", at 0.05 d",
            .x_label = "",
            .y_label = "recall, %",
            .labels = column_names(set, group_modulo),
            .y_percent = true};
  for (size_t i = 0; i < results.size(); ++i) {
    Series series{experiment.variants[i].method, {}, {}};
    for (const Recall& recall : column_recalls(set, results[i].scores, group_modulo))
      series.y.push_back(100 * recall.rate(1));
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot time_bars(const Experiment& experiment, const std::vector<VariantResult>& results) {
  Plot plot{.kind = Plot::Kind::kBars,
            .file = experiment.key,
            .title = experiment.title,
            .x_label = "",
            .y_label = "mean time, ms"};
  Series verification{"verification", {}, {}}, all{"everything", {}, {}};
  for (size_t i = 0; i < results.size(); ++i) {
    plot.labels.push_back(experiment.variants[i].method);
    verification.y.push_back(1e3 * results[i].verification_seconds);
    all.y.push_back(1e3 * results[i].seconds);
  }
  plot.series = {std::move(verification), std::move(all)};
  return plot;
}

}  // namespace

StudySection describe(const TestSet& set, const Experiment& experiment,
                      const std::vector<VariantResult>& results, int group_modulo) {
  StudySection section;
  section.markdown = "## " + experiment.title + "\n\n" + experiment.note + "\n\n";
  switch (experiment.layout) {
    case Experiment::Layout::kBySetting:
      section.markdown += by_setting(experiment, results);
      section.plots = {curves(experiment, results)};
      break;
    case Experiment::Layout::kByObject:
      section.markdown += by_object(set, experiment, results, group_modulo);
      section.plots = {recall_bars(set, experiment, results, group_modulo)};
      break;
    case Experiment::Layout::kByTime:
      section.markdown += by_time(experiment, results);
      section.plots = {time_bars(experiment, results)};
      break;
    case Experiment::Layout::kSweep:
      section.markdown += by_sweep(experiment, results);
      section.plots = {curves(experiment, results), time_curve(experiment, results)};
      break;
  }
  section.markdown += "\n";
  return section;
}

}  // namespace edgepose
