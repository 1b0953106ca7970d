#include "evaluation/statistics.h"

#include <algorithm>
#include <numeric>

namespace edgepose {

double percentile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double place = std::clamp(p, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const size_t below = static_cast<size_t>(place), above = std::min(below + 1, values.size() - 1);
  const double share = place - static_cast<double>(below);
  // Not low + share * (high - low): that is NaN between two infinities.
  return share == 0 ? values[below] : (1 - share) * values[below] + share * values[above];
}

double median(std::vector<double> values) { return percentile(std::move(values), 0.5); }

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace edgepose
