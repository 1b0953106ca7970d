#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

namespace edgepose::phantom {

/// One planned hole, in the phantom's frame. Millimetres.
struct DrillTarget {
  std::string name;
  Eigen::Vector3d entry;  ///< on the surface
  Eigen::Vector3d axis;   ///< unit, into the bone
  double depth;           ///< from the entry to the tip
  double diameter;
  double tolerance;      ///< of the entry point
  double tolerance_deg;  ///< of the axis
};

/// The plan for the phantom: a pedicle screw on each side and a pin in the spinous process. Entry points are
/// found by ray casting. Throws std::runtime_error if a hole would leave the bone.
std::vector<DrillTarget> drill_plan();

}  // namespace edgepose::phantom
