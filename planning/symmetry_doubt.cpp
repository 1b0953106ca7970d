#include "planning/symmetry_doubt.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "matcher/symmetry_axis.h"

namespace edgepose {
namespace {

constexpr double kSameSize = 1e-6;  // [m]

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Whether the moved hole is `there`, within the tolerances of `there`.
bool coincides(const DrillTarget& moved, const DrillTarget& there) {
  const auto bottom = [](const DrillTarget& t) { return Eigen::Vector3d(t.entry + t.depth * t.axis); };
  return (moved.entry - there.entry).norm() <= there.position_tolerance &&
         (bottom(moved) - bottom(there)).norm() <= there.position_tolerance &&
         angle_between(moved.axis, there.axis) <= there.angle_tolerance &&
         std::abs(moved.depth - there.depth) < kSameSize &&
         std::abs(moved.diameter - there.diameter) < kSameSize;
}

bool moves_away(const DrillTarget& target, const DrillPlan& plan, const RigidTransform& symmetry) {
  DrillTarget moved = target;
  moved.entry = symmetry * target.entry;
  moved.axis = symmetry.linear() * target.axis;
  return std::none_of(plan.targets.begin(), plan.targets.end(),
                      [&](const DrillTarget& there) { return coincides(moved, there); });
}

}  // namespace

bool is_ambiguous(const DrillTarget& target, const DrillPlan& plan, const Symmetries& symmetries) {
  for (const RigidTransform& symmetry : symmetries.discrete)
    if (moves_away(target, plan, symmetry)) return true;
  // A hole on the axis stays; any other is moved by half a turn, or by a turn that meets no hole of the plan.
  constexpr std::array<double, 3> kTurns = {3.14159265358979, 1.0, 2.0};  // [rad]
  for (const SymmetryAxis& axis : symmetries.continuous)
    for (const double angle : kTurns)
      if (moves_away(target, plan, turn_about(axis, angle))) return true;
  return false;
}

}  // namespace edgepose
