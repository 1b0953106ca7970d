#pragma once
#include <vector>

#include "matcher/nearest_surface.h"
#include "matcher/types.h"

namespace edgepose {

/// Measures how well a rigid motion maps a surface onto itself.
class SelfMatch {
 public:
  /// `samples` of the surface 0.018 diameters apart, every prefix evenly spread; they must outlive this.
  /// `crowd`: many points in proportion to area, for the moments: those of the few samples are off by 2 %,
  /// which turns the principal axes of a body that is nearly a cube by 10 degrees.
  SelfMatch(const std::vector<OrientedPoint>& samples, const std::vector<OrientedPoint>& crowd,
            float diameter);

  /// How far the moved surface is from the resting one, along the normals.
  struct Distance {
    float mean;      ///< [d]
    float off;       ///< share of the points that are off by more than a trifle (0.006 d)
    float outliers;  ///< share of the points that have no surface beside them
    bool is_match() const;
  };
  Distance distance(const RigidTransform& motion) const;

  /// Moves `motion` to where the surfaces match best nearby (point to plane); false if they do not meet.
  bool refine(RigidTransform& motion) const;

  const Eigen::Vector3d& centroid() const { return centroid_; }
  const Eigen::Matrix3d& inertia() const { return inertia_; }  ///< second moments about the centroid [d^2]

 private:
  bool step(const NearestSurface& nearest, size_t count, RigidTransform& motion, double& moved) const;

  const std::vector<OrientedPoint>& samples_;
  float diameter_;
  Eigen::Vector3d centroid_;
  Eigen::Matrix3d inertia_;
  NearestSurface coarse_, fine_;
};

}  // namespace edgepose
