#pragma once
#include <cstdint>
#include <vector>

#include "matcher/oriented_point.h"

namespace edgepose {

/// Finds the surface point beside a given one, in cells as wide as the reach of the search.
class NearestSurface {
 public:
  /// Looks among the first `count` points of `surface`, which must outlive this, up to `reach` [m] away.
  NearestSurface(const std::vector<OrientedPoint>& surface, size_t count, float reach);

  /// The nearest point that faces the same way as `normal` to within 60 degrees; null if none is in reach.
  const OrientedPoint* find(const Eigen::Vector3f& position, const Eigen::Vector3f& normal) const;

 private:
  Eigen::Vector3i cell_of(const Eigen::Vector3f& p) const;
  int index(const Eigen::Vector3i& c) const { return (c.z() * cells_.y() + c.y()) * cells_.x() + c.x(); }

  float reach_;
  Eigen::Vector3f corner_;
  Eigen::Vector3i cells_;              // along each axis
  std::vector<uint32_t> first_;        // cell c holds points_[first_[c]] to points_[first_[c + 1]]
  std::vector<OrientedPoint> points_;  // cell by cell
};

}  // namespace edgepose
