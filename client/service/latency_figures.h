#pragma once
#include <cstddef>
#include <vector>

namespace edgepose {

/// [s] Median and 99th percentile of what was measured; 0 for none.
struct LatencyFigures {
  size_t count = 0;
  double p50 = 0, p99 = 0, worst = 0;
};
LatencyFigures latency_figures(const std::vector<double>& seconds);

}  // namespace edgepose
