#include "experiment/experiment_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evaluation/report.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose {
namespace {

constexpr double kWithin = 0.001;                        // [m]
constexpr double kWithinAngle = std::numbers::pi / 180;  // [rad]
constexpr double kDegrees = 180 / std::numbers::pi;

template <class Value>
std::vector<double> values_of(const ArmResults& arm, const Value& value) {
  std::vector<double> values;
  for (const TrialResult& trial : arm.trials) values.push_back(value(trial));
  return values;
}

double most(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

std::string share_text(const ArmResults& arm) {
  const auto hits =
      static_cast<size_t>(std::count_if(arm.trials.begin(), arm.trials.end(), [](const TrialResult& trial) {
        return trial.within(kWithin, kWithinAngle);
      }));
  const Share share = wilson(hits, arm.trials.size());
  return percent(share.share) + " (" + percent(share.low) + " to " + percent(share.high) + ")";
}

std::string arm_letter(const ArmResults& arm) { return arm.arm.name; }

/// Distance to the hole over the steps, median of the trials; one that has ended stays where it was.
Plot distances_plot(const std::vector<ArmResults>& results) {
  Plot plot{.kind = Plot::Kind::kLines,
            .file = "distance_over_steps",
            .title = "Distance of the true tip from the hole, median",
            .x_label = "step of 2 s",
            .y_label = "mm"};
  for (const ArmResults& arm : results) {
    Series series{arm_letter(arm), {}, {}};
    size_t longest = 0;
    for (const TrialResult& trial : arm.trials) longest = std::max(longest, trial.distances.size());
    for (size_t step = 0; step < longest; ++step) {
      series.x.push_back(static_cast<double>(step));
      series.y.push_back(1e3 * median(values_of(arm, [&](const TrialResult& trial) {
                           return trial.distances.empty()
                                      ? 0
                                      : trial.distances[std::min(step, trial.distances.size() - 1)];
                         })));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// Share of the trials that end within so much.
Plot shares_plot(const std::vector<ArmResults>& results) {
  Plot plot{.kind = Plot::Kind::kLines,
            .file = "share_by_distance",
            .title = "Share of the trials that end within a distance of the hole",
            .x_label = "mm",
            .y_label = "share, %",
            .y_percent = true};
  constexpr int kSteps = 150;
  constexpr double kMost = 3.0;  // [mm]
  for (const ArmResults& arm : results) {
    Series series{arm_letter(arm), {}, {}};
    for (int i = 0; i <= kSteps; ++i) {
      const double limit = kMost * i / kSteps;
      const auto within = std::count_if(arm.trials.begin(), arm.trials.end(), [&](const TrialResult& trial) {
        return trial.end == "converged" && 1e3 * trial.error.translation <= limit;
      });
      series.x.push_back(limit);
      series.y.push_back(arm.trials.empty()
                             ? 0
                             : 100.0 * static_cast<double>(within) / static_cast<double>(arm.trials.size()));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::string failures_text(const std::vector<ArmResults>& results) {
  std::string text;
  for (const ArmResults& arm : results)
    for (const TrialResult& trial : arm.trials)
      if (trial.end != "converged")
        text += "- " + arm.arm.name + ", seed " + std::to_string(trial.seed) + ": " +
                harmless_text(trial.end) + ", " + fixed(1e3 * trial.error.translation, 2) + " mm away\n";
  return text.empty() ? "None.\n" : text;
}

}  // namespace

Share wilson(size_t hits, size_t all) {
  if (all == 0) return {};
  constexpr double z = 1.959964;
  const double n = static_cast<double>(all), p = static_cast<double>(hits) / n;
  const double middle = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {p, std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string results_table(const std::vector<ArmResults>& results) {
  Table table({"goal", "trials", "median mm", "p95 mm", "most mm", "median deg", "p95 deg", "most deg",
               "within 1 mm and 1 degree, %", "not converged", "steps, median"});
  for (const ArmResults& arm : results) {
    const auto distances = values_of(arm, [](const TrialResult& t) { return 1e3 * t.error.translation; });
    const auto angles = values_of(arm, [](const TrialResult& t) { return kDegrees * t.error.angle; });
    const auto steps = values_of(arm, [](const TrialResult& t) { return static_cast<double>(t.steps); });
    const auto failed = std::count_if(arm.trials.begin(), arm.trials.end(),
                                      [](const TrialResult& t) { return t.end != "converged"; });
    table.add({arm.arm.name, count_text(arm.trials.size()), fixed(median(distances), 3),
               fixed(percentile(distances, 0.95), 3), fixed(most(distances), 3), fixed(median(angles), 3),
               fixed(percentile(angles, 0.95), 3), fixed(most(angles), 3), share_text(arm),
               count_text(static_cast<size_t>(failed)), fixed(median(steps), 0)});
  }
  return table.markdown();
}

void write_report(const std::filesystem::path& folder, const std::vector<ArmResults>& results,
                  const std::string& command, const std::string& date) {
  std::string warning;
  FileGroup files;
  const std::string pictures =
      draw_all({distances_plot(results), shares_plot(results)}, folder, files, warning);
  files.add(
      folder / "report.md",
      "# The positioning experiment\n\n    " + command + "\n\n" + date +
          ". Error of the true tip against the planned hole, and of the true axis; a trial counts as "
          "within only if the controller said converged. Shares with their 95 % Wilson interval. Trials "
          "that did not converge are counted with where they ended.\n\n" +
          results_table(results) + "\n## Trials that did not converge\n\n" + failures_text(results) +
          "\n## Plots\n\n" + pictures);
  files.commit();
}

}  // namespace edgepose
