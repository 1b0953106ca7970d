#pragma once
#include <cstdint>
#include <vector>

#include "matcher/types.h"

/// What lies about the phantom in the sample scenes. Metres, in the table's frame: z up, the table's top is
/// z = 0, the middle is the origin.
namespace edgepose::phantom {

/// A box with the given corners.
Mesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// A round rod along a line of points, with a radius at each of them and closed ends: instruments.
Mesh rod(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& radii);

/// Soft tissue: a mound on the table with an opening over the origin.
struct Tissue {
  double height = 0.06;      ///< [m] of the mound about the opening
  double floor = 0.045;      ///< [m] height of what is left in the opening
  double opening_x = 0.03;   ///< [m] half width of the opening
  double opening_y = 0.045;  ///< [m] half length
  double bumps = 0.003;      ///< [m] roughness
  uint64_t seed = 1;
};
Mesh tissue(const Tissue& tissue);

}  // namespace edgepose::phantom
