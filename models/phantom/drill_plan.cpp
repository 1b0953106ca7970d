#include "models/phantom/drill_plan.h"

#include <stdexcept>

#include "models/phantom/phantom_shape.h"

namespace edgepose::phantom {
namespace {

using Eigen::Vector3d;

/// A hole whose axis goes through `waypoint` along `direction`.
DrillTarget plan(const std::string& name, const Vector3d& waypoint, const Vector3d& direction, double depth,
                 double diameter, double tolerance, double tolerance_deg) {
  const Vector3d axis = direction.normalized();
  DrillTarget target{name,         first_hit(waypoint - 80 * axis, axis), axis, depth, diameter, tolerance,
                     tolerance_deg};
  // The first millimetres cannot lie deep: there the hole comes in through a curved surface.
  for (double reached = 1.5 * diameter; reached <= depth; reached += 0.5) {
    const double clearance = -signed_distance(target.entry + reached * axis) - diameter / 2;
    if (clearance < 0) throw std::runtime_error("phantom: the hole " + name + " leaves the bone");
  }
  return target;
}

}  // namespace

std::vector<DrillTarget> drill_plan() {
  return {
      // Through the middle of the pedicle into the body, converging by 10 degrees as surgeons do.
      plan("left_pedicle_screw", {15.4, 19, 4.8}, {-0.17, -1, 0}, 40, 5, 1.5, 3),
      plan("right_pedicle_screw", {-15.4, 19, 4.8}, {0.17, -1, 0}, 40, 5, 1.5, 3),
      plan("spinous_process_pin", {-1.6, 58, -9.2}, {0.09, -1, 0.28}, 14, 2, 1, 5),
  };
}

}  // namespace edgepose::phantom
