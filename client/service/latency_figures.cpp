#include "client/service/latency_figures.h"

#include <algorithm>

#include "evaluation/statistics.h"

namespace edgepose {

LatencyFigures latency_figures(const std::vector<double>& seconds) {
  if (seconds.empty()) return {};
  return {seconds.size(), percentile(seconds, 0.5), percentile(seconds, 0.99),
          *std::max_element(seconds.begin(), seconds.end())};
}

}  // namespace edgepose
