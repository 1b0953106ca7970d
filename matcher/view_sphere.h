#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "matcher/oriented_point.h"

namespace edgepose {

/// `count` directions spread evenly over the sphere (Fibonacci lattice), from the model towards the camera.
std::vector<Eigen::Vector3f> view_directions(int count);

/// A point of the model's outline as seen from one view.
struct ContourPoint {
  Eigen::Vector3f position;  ///< [m] model frame
  Eigen::Vector3f outwards;  ///< unit, perpendicular to the view direction, away from the object
};

/// What one view shows of the model.
struct ViewVisibility {
  std::vector<bool> visible;          ///< for each queried point
  std::vector<ContourPoint> contour;  ///< occluding edges: where the surface ends against something deeper
};

/// Renders `surface` (dense samples) orthographically from each direction and tells which of `queries` are
/// visible and where the outlines run. `diameter` in metres sets the resolution (diameter / 110 a pixel).
std::vector<ViewVisibility> look_from_all_sides(const std::vector<OrientedPoint>& surface,
                                                const std::vector<OrientedPoint>& queries,
                                                const std::vector<Eigen::Vector3f>& directions,
                                                float diameter, size_t max_contour_points, int threads);

}  // namespace edgepose
