#include "arm/motion_limiter.h"

#include <algorithm>
#include <cmath>

#include "arm/kinematics.h"
#include "matcher/option_range.h"

namespace edgepose {
namespace {

constexpr int kHalvings = 5;  // of the share of the wanted velocity that is tried

AxisMotion axis(const JointState& state, int joint) {
  return {state.position[joint], state.velocity[joint], state.acceleration[joint]};
}

void set_axis(JointState& state, int joint, const AxisMotion& axis) {
  state.position[joint] = axis.position;
  state.velocity[joint] = axis.velocity;
  state.acceleration[joint] = axis.acceleration;
}

/// Joint velocities within the limits, in the direction that is wanted.
JointVector feasible(const JointVector& wanted, const ArmGeometry& arm, const JointState& now,
                     const TipLimit& tip, const MotionOptions& options) {
  if (!wanted.allFinite()) return JointVector::Zero();
  double share = 1;
  for (int i = 0; i < kJoints; ++i)
    share =
        std::min(share, arm.max_velocity[i] * options.velocity_share / std::max(std::abs(wanted[i]), 1e-12));
  const double speed = point_velocity(arm, now.position, wanted, tip.flange_point).norm();
  if (speed > 0) share = std::min(share, options.planned_share * tip.speed / speed);
  return share * wanted;
}

/// At every cycle of the stop that would follow. These are the very states that the stop goes through, so
/// what is found here still holds when it is made.
bool tip_stays_slow(const ArmGeometry& arm, const JointState& state, const TipLimit& tip,
                    const MotionOptions& options) {
  if (std::isinf(tip.speed)) return true;
  JointState s = state;
  const int cycles = static_cast<int>(std::ceil(stop_duration(state, options) / options.cycle));
  for (int k = 0; k <= cycles; ++k) {
    if (!(point_velocity(arm, s.position, s.velocity, tip.flange_point).norm() <=
          options.planned_share * tip.speed))
      return false;
    s = stop_motion(s, options);
  }
  return true;
}

/// One cycle towards `velocity`, or why it must not be taken.
LimitedMotion attempt(const ArmGeometry& arm, const JointState& now, const JointVector& velocity,
                      const TipLimit& tip, const MotionOptions& options) {
  LimitedMotion motion;
  for (int i = 0; i < kJoints; ++i) {
    const AxisLimits limits = axis_limits(arm, options, i);
    const AxisMotion from = axis(now, i);
    const VelocityProfile profile = velocity_profile(from, velocity[i], limits.acceleration, limits.jerk);
    const AxisMotion next = profile.after(from, options.cycle);
    const MotionExtent passed = extent(from, profile, options.cycle);
    if (passed.lowest < limits.lower || passed.highest > limits.upper || !can_stop(next, limits)) {
      motion.bound = MotionBound::kJointLimit;
      motion.joint = i;
      return motion;
    }
    set_axis(motion.next, i, next);
  }
  if (!tip_stays_slow(arm, motion.next, tip, options)) motion.bound = MotionBound::kTipSpeed;
  return motion;
}

}  // namespace

std::string MotionOptions::check() const {
  return option_fault({{"cycle", cycle, 1e-4, 0.1},
                       {"acceleration", acceleration, 0.01, 1000},
                       {"jerk", jerk, 0.1, 1e5},
                       {"joint_margin", joint_margin, 0, 1},
                       {"velocity_share", velocity_share, 1e-3, 1},
                       {"planned_share", planned_share, 0.5, 1}});
}

AxisLimits axis_limits(const ArmGeometry& arm, const MotionOptions& options, int joint) {
  return {arm.lower[joint] + options.joint_margin, arm.upper[joint] - options.joint_margin,
          arm.max_velocity[joint] * options.velocity_share, options.acceleration, options.jerk};
}

LimitedMotion limit_motion(const ArmGeometry& arm, const JointState& now, const JointVector& wanted,
                           const TipLimit& tip, const MotionOptions& options) {
  const JointVector velocity = feasible(wanted, arm, now, tip, options);
  LimitedMotion whole = attempt(arm, now, velocity, tip, options);
  if (whole.bound == MotionBound::kNone) return whole;
  // The same share for all joints keeps the direction. The stop is allowed whatever the state.
  LimitedMotion best{stop_motion(now, options), whole.bound, whole.joint};
  double taken = 0, refused = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double share = (taken + refused) / 2;
    const LimitedMotion part = attempt(arm, now, share * velocity, tip, options);
    (part.bound == MotionBound::kNone ? taken : refused) = share;
    if (part.bound == MotionBound::kNone) best.next = part.next;
  }
  return best;
}

JointState stop_motion(const JointState& now, const MotionOptions& options) {
  JointState next;
  for (int i = 0; i < kJoints; ++i) {
    const AxisMotion from = axis(now, i);
    set_axis(next, i,
             velocity_profile(from, 0, options.acceleration, options.jerk).after(from, options.cycle));
  }
  return next;
}

double stop_duration(const JointState& now, const MotionOptions& options) {
  double longest = 0;
  for (int i = 0; i < kJoints; ++i)
    longest =
        std::max(longest, velocity_profile(axis(now, i), 0, options.acceleration, options.jerk).duration());
  return longest;
}

bool at_rest(const JointState& state) { return state.velocity.isZero(0) && state.acceleration.isZero(0); }

}  // namespace edgepose
