#include <algorithm>
#include <cmath>
#include <map>

#include "evaluation/report.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose {
namespace {

constexpr double kLargestThreshold = 0.1;  ///< [d] where the recall curves end

std::string label_of(double threshold) { return fixed(threshold, 2) + " d"; }

Plot recall_by_object(const EvalReport& report) {
  Plot plot{.kind = Plot::Kind::kBars,
            .file = "recall_by_object",
            .title = "Recall by object",
            .x_label = "",
            .y_label = "recall, %",
            .y_percent = true};
  for (double threshold : kThresholds) plot.series.push_back({label_of(threshold), {}, {}});
  const auto add = [&](const std::string& label, auto&& rate) {
    plot.labels.push_back(label);
    for (size_t k = 0; k < kThresholds.size(); ++k) plot.series[k].y.push_back(100 * rate(k));
  };
  for (const TestObject& object : report.set.objects) {
    const auto recall = report.scores.objects.find(object.id);
    if (recall != report.scores.objects.end())
      add(object.name, [&](size_t k) { return recall->second.rate(k); });
  }
  if (plot.labels.size() > 1) add("mean", [&](size_t k) { return report.scores.mean_recall[k]; });
  return plot;
}

/// Recall as a function of the allowed error.
Series threshold_curve(const std::string& name, const std::vector<double>& relative_errors) {
  constexpr int kSteps = 200;
  Series series{name, {}, {}};
  for (int i = 0; i <= kSteps; ++i) {
    const double threshold = kLargestThreshold * i / kSteps;
    const auto correct = std::count_if(relative_errors.begin(), relative_errors.end(),
                                       [&](double e) { return e < threshold; });
    series.x.push_back(threshold);
    series.y.push_back(100.0 * static_cast<double>(correct) / static_cast<double>(relative_errors.size()));
  }
  return series;
}

Plot recall_by_threshold(const EvalReport& report) {
  Plot plot{.kind = Plot::Kind::kLines,
            .file = "recall_by_threshold",
            .title = "Recall by allowed error",
            .x_label = "allowed error, diameters",
            .y_label = "recall, %",
            .y_percent = true};
  std::map<int, std::vector<double>> by_object;
  std::vector<double> all;
  for (const InstanceScore& i : report.scores.instances) {
    by_object[i.object_id].push_back(i.error / i.diameter);
    all.push_back(i.error / i.diameter);
  }
  if (all.empty()) return plot;
  for (const TestObject& object : report.set.objects)
    if (by_object.size() > 1 && by_object.count(object.id))
      plot.series.push_back(threshold_curve(object.name, by_object[object.id]));
  plot.series.push_back(threshold_curve("all", all));
  plot.series.back().bold = true;
  return plot;
}

/// About twenty bins of a round width from 0 on; what lies beyond the 98th percentile is counted in the last.
Plot histogram(std::string file, std::string title, std::string x_label, const std::vector<double>& values) {
  Plot plot{.kind = Plot::Kind::kHistogram,
            .file = std::move(file),
            .title = std::move(title),
            .x_label = std::move(x_label),
            .y_label = "count"};
  const double wanted = std::max(1e-3, percentile(values, 0.98)) / 20;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  double width = 10 * power;
  for (double round : {5.0, 2.0, 1.0})
    if (round * power >= wanted) width = round * power;
  const size_t bins = static_cast<size_t>(std::ceil(std::max(1e-3, percentile(values, 0.98)) / width));
  Series series{"", {}, std::vector<double>(bins, 0.0)};
  for (double value : values)
    series.y[std::min(bins - 1, static_cast<size_t>(std::max(0.0, value / width)))] += 1;
  for (size_t i = 0; i < bins; ++i) series.x.push_back(width * (static_cast<double>(i) + 0.5));
  plot.series.push_back(std::move(series));
  return plot;
}

Plot error_histogram(const EvalReport& report) {
  std::vector<double> errors;
  for (const InstanceScore& i : report.scores.instances)
    if (i.correct(kLargestThreshold)) errors.push_back(1e3 * i.error);
  return histogram("error_histogram", "Errors of the poses correct at 0.1 d (last bar: this and more)",
                   "error, mm", errors);
}

Plot time_histogram(const std::vector<double>& milliseconds_each) {
  return histogram("time_histogram", "Time for one object in one image (last bar: this and more)", "time, ms",
                   milliseconds_each);
}

Plot time_distribution(std::vector<double> milliseconds_each) {
  Plot plot{.kind = Plot::Kind::kSteps,
            .file = "time_distribution",
            .title = "Share of the questions answered within a time",
            .x_label = "time for one object in one image, ms",
            .y_label = "questions answered, %",
            .y_percent = true,
            .log_x = true};
  std::sort(milliseconds_each.begin(), milliseconds_each.end());
  Series series{"", {}, {}};
  for (size_t i = 0; i < milliseconds_each.size(); ++i) {
    series.x.push_back(milliseconds_each[i]);
    series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(milliseconds_each.size()));
  }
  plot.series.push_back(std::move(series));
  return plot;
}

/// Mean time of each stage, stacked, one bar an object.
Plot stages_by_object(const EvalReport& report) {
  Plot plot{.kind = Plot::Kind::kStackedBars,
            .file = "stages",
            .title = "Mean time by stage",
            .x_label = "",
            .y_label = "ms"};
  struct Stage {
    const char* name;
    double (*time)(const EvalRow&);
  };
  const Stage stages[] = {{"preprocessing", [](const EvalRow& r) { return r.preprocessing; }},
                          {"sampling", [](const EvalRow& r) { return r.stages.sampling; }},
                          {"voting", [](const EvalRow& r) { return r.stages.voting; }},
                          {"clustering", [](const EvalRow& r) { return r.stages.clustering; }},
                          {"verification", [](const EvalRow& r) { return r.stages.verification; }},
                          {"refinement", [](const EvalRow& r) { return r.stages.refinement; }}};
  for (const Stage& stage : stages) plot.series.push_back({stage.name, {}, {}});
  for (const TestObject& object : report.set.objects) {
    plot.labels.push_back(object.name);
    for (size_t k = 0; k < std::size(stages); ++k) {
      std::vector<double> times;
      for (const EvalRow& row : report.evaluation.rows)
        if (row.object_id == object.id) times.push_back(1e3 * stages[k].time(row));
      plot.series[k].y.push_back(mean(times));
    }
  }
  return plot;
}

Plot recall_by_visibility(const EvalReport& report) {
  constexpr size_t kBins = 10;
  Plot plot{.kind = Plot::Kind::kBars,
            .file = "recall_by_visibility",
            .title = "Recall by visible share of the silhouette",
            .x_label = "visible, % (instances)",
            .y_label = "recall, %",
            .y_percent = true};
  std::array<Recall, kBins> bins;
  for (const InstanceScore& i : report.scores.instances)
    bins[std::min(kBins - 1, static_cast<size_t>(std::max(0.0, i.visible) * kBins))].add(i);
  for (double threshold : kThresholds) plot.series.push_back({label_of(threshold), {}, {}});
  for (size_t b = 0; b < kBins; ++b) {
    if (bins[b].instances == 0) continue;  // shown as missing, not as no recall
    plot.labels.push_back(std::to_string(10 * b) + "-" + std::to_string(10 * b + 10) + " (" +
                          count_text(bins[b].instances) + ")");
    for (size_t k = 0; k < kThresholds.size(); ++k) plot.series[k].y.push_back(100 * bins[b].rate(k));
  }
  return plot;
}

}  // namespace

std::vector<Plot> result_plots(const EvalReport& report) {
  std::vector<double> milliseconds_each;
  for (const EvalRow& row : report.evaluation.rows) milliseconds_each.push_back(1e3 * row.seconds);
  std::vector<Plot> plots = {recall_by_object(report), recall_by_threshold(report),
                             recall_by_visibility(report), error_histogram(report)};
  if (!milliseconds_each.empty()) {
    plots.push_back(time_histogram(milliseconds_each));
    plots.push_back(time_distribution(milliseconds_each));
    plots.push_back(stages_by_object(report));
  }
  std::erase_if(plots, [](const Plot& plot) { return plot.series.empty(); });
  return plots;
}

}  // namespace edgepose
