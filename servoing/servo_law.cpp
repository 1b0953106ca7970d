#include "servoing/servo_law.h"

#include <algorithm>
#include <cmath>

#include "arm/rigid_motion.h"
#include "matcher/option_range.h"

namespace edgepose {

GoalError goal_error(const RigidTransform& goal_T_body) {
  return {goal_T_body.translation().norm(), rotation_angle(goal_T_body)};
}

double AdaptiveGain::operator()(double error) const {
  const double range = at_zero - at_infinity;
  return range > 0 ? range * std::exp(-slope_at_zero * error / range) + at_infinity : at_zero;
}

std::string AdaptiveGain::check() const {
  return option_fault({{"gain.at_zero", at_zero, 0.01, 20},
                       {"gain.at_infinity", at_infinity, 0.01, at_zero},
                       {"gain.slope_at_zero", slope_at_zero, 0, 1000}});
}

ServoCommand servo_command(const RigidTransform& goal_T_body, const AdaptiveGain& gain) {
  const Eigen::Vector3d turn = rotation_vector(goal_T_body.linear());
  ServoCommand command;
  if (!(turn.norm() < kHalfTurnGuard)) {
    command.near_half_turn = true;
    return command;
  }
  const double largest =
      std::max(goal_T_body.translation().cwiseAbs().maxCoeff(), turn.cwiseAbs().maxCoeff());
  command.gain = gain(largest);
  // A rotation vector is the same in the axes of the goal and of the body.
  command.body_twist << -command.gain * (goal_T_body.linear().transpose() * goal_T_body.translation()),
      -command.gain * turn;
  return command;
}

}  // namespace edgepose
