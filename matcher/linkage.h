#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace edgepose {

/// Single-linkage clusters: points less than `link` [m] apart are in one. For each point the number of its
/// cluster; numbers ascend with each cluster's first point.
std::vector<uint32_t> link_clusters(const std::vector<Eigen::Vector3f>& points, float link);

}  // namespace edgepose
