#pragma once
#include <Eigen/Core>
#include <vector>

namespace edgepose {

/// The largest distance between two points, at most 0.1 % too small (and mostly exact), in time proportional
/// to the number of points, also where all lie on a sphere. 0 for fewer than two points.
double largest_spread(const std::vector<Eigen::Vector3f>& points);

}  // namespace edgepose
