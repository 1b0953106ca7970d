#include "bench/comparison.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace edgepose::bench {
namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<size_t>(at)];
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// "-" where there is none.
std::string median_millimetres(const std::vector<double>& metres) {
  if (metres.empty()) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f mm", 1e3 * quantile(metres, 0.5));
  return text;
}

}  // namespace

std::string comparison_table(const std::vector<Tally>& tallies) {
  std::string text =
      "| method | asked | correct at 0.05 d | no answer | over the limit | crashed | time an object: median "
      "| mean | "
      "worst | training an object | error of the correct, median "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Tally& t : tallies) {
    char row[512];
    std::snprintf(
        row, sizeof row,
        "| %s | %zu | %zu (%.1f %%) | %zu | %zu | %zu | %.0f ms | %.0f ms | %.0f ms | %.2f s | %s |\n",
        t.method.c_str(), t.asked, t.correct,
        t.asked > 0 ? 100.0 * static_cast<double>(t.correct) / static_cast<double>(t.asked) : 0.0, t.nothing,
        t.timed_out, t.crashed, 1e3 * quantile(t.seconds, 0.5), 1e3 * mean(t.seconds),
        1e3 * quantile(t.seconds, 1),
        t.train_seconds / static_cast<double>(std::max<size_t>(1, t.objects_trained)),
        median_millimetres(t.errors).c_str());
    text += row;
  }
  text += '\n';
  for (const Tally& t : tallies) text += "- " + t.method + ": " + t.settings + '\n';
  return text;
}

}  // namespace edgepose::bench
