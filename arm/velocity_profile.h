#pragma once
#include <array>
#include <limits>

namespace edgepose {

/// One joint, or any other axis. [rad], [rad/s], [rad/s^2].
struct AxisMotion {
  double position = 0, velocity = 0, acceleration = 0;
};

struct AxisLimits {
  double lower = 0, upper = 0;  ///< [rad] of the position
  double velocity = 0;          ///< [rad/s]    of its absolute value, as the two below
  double acceleration = 0;      ///< [rad/s^2]
  double jerk = 0;              ///< [rad/s^3]
};

/// The fastest way to `target` velocity and no acceleration within the limits of acceleration and jerk: up to
/// three phases of constant jerk (Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and
/// Robots, 2008, Sec. 3.4). With target 0 it is the controlled stop. Where the state is on the profile
/// already, what is left of it.
struct VelocityProfile {
  struct Phase {
    double duration = 0, jerk = 0;  ///< [s], [rad/s^3]
  };
  std::array<Phase, 3> phases;
  double target = 0;  ///< [rad/s]

  double duration() const;  ///< [s]
  AxisMotion after(AxisMotion from,
                   double t) const;  ///< where `from` is after t seconds; then at the target's velocity
};

VelocityProfile velocity_profile(const AxisMotion& from, double target, double max_acceleration,
                                 double max_jerk);

/// What the motion passes through in the first `horizon` seconds of the profile, between the samples too.
struct MotionExtent {
  double lowest = 0, highest = 0;  ///< [rad]
  double speed = 0;                ///< [rad/s] largest
};
MotionExtent extent(const AxisMotion& from, const VelocityProfile& profile,
                    double horizon = std::numeric_limits<double>::infinity());

/// Whether the state and the whole controlled stop from it are within the limits: the set of states a motion
/// may enter. From each of them the stop leads on within the set.
bool can_stop(const AxisMotion& state, const AxisLimits& limits);

}  // namespace edgepose
