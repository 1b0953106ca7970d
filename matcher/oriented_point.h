#pragma once
#include <Eigen/Core>
#include <vector>

namespace edgepose {

/// A surface point with its outward unit normal; metres.
struct OrientedPoint {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
};
static_assert(sizeof(OrientedPoint) == 24);

}  // namespace edgepose
