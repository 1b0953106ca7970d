#pragma once
#include <vector>

namespace edgepose {

/// p in [0, 1], interpolated linearly between neighbours in the sorted list, as numpy does; 0 for none.
double percentile(std::vector<double> values, double p);
double median(std::vector<double> values);
double mean(const std::vector<double>& values);  ///< 0 for none

}  // namespace edgepose
