#pragma once
#include <string>

#include "arm/arm_geometry.h"
#include "arm/velocity_profile.h"

namespace edgepose {

/// What no commanded motion exceeds. Velocities and mechanical limits of the joints are the arm's own.
struct MotionOptions {
  double cycle = 0.005;         ///< [s] between two commanded positions; the bus's
  double acceleration = 5;      ///< [rad/s^2] of each joint; less makes stops longer
  double jerk = 50;             ///< [rad/s^3] of each joint; less makes stops longer and motion smoother
  double joint_margin = 0.1;    ///< [rad] kept from the mechanical limits, as MoveIt Servo
  double velocity_share = 1;    ///< (0, 1] of the joints' largest velocities
  double planned_share = 0.98;  ///< (0, 1] of the tip's speed limit that is planned with; the rest is for
                                ///< what happens between two cycles

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// How fast the tip may be. Not above `speed` at any cycle, from any state that was reached under it; under a
/// smaller limit than before, the arm slows down at once as its jerk and acceleration allow.
struct TipLimit {
  Eigen::Vector3d flange_point = Eigen::Vector3d::Zero();  ///< [m] flange frame: the tip
  double speed = 0.05;                                     ///< [m/s] > 0; infinite: none
};

enum class MotionBound {
  kNone,        ///< the wanted velocity is being reached as fast as acceleration and jerk allow
  kJointLimit,  ///< a joint could not stop before its limit: all joints are slowed down
  kTipSpeed,    ///< the tip would be too fast on the way: all joints are slowed down
};

struct LimitedMotion {
  JointState next;                         ///< to be commanded in the next cycle
  MotionBound bound = MotionBound::kNone;  ///< what held the motion back ...
  int joint = -1;                          ///< ... and which joint (0 to 5), of kJointLimit
};

AxisLimits axis_limits(const ArmGeometry& arm, const MotionOptions& options, int joint);

/// One cycle of motion towards the wanted joint velocities [rad/s]. Position, velocity, acceleration and jerk
/// of each joint and the speed of the tip stay within their limits, and it is made sure that a stop from the
/// next state does too; if the wanted velocity allows no such state, a part of it is taken, down to none,
/// which is the controlled stop. Wanted velocities that are not finite count as none. Pure; 10 to 50 us.
/// `now` is what was commanded last (a JointState within the limits, at rest to begin with), not what was
/// measured.
LimitedMotion limit_motion(const ArmGeometry& arm, const JointState& now, const JointVector& wanted,
                           const TipLimit& tip, const MotionOptions& options);

/// One cycle of the controlled stop: each joint comes to rest as fast as acceleration and jerk allow.
JointState stop_motion(const JointState& now, const MotionOptions& options);

/// [s] until the controlled stop has brought all joints to rest.
double stop_duration(const JointState& now, const MotionOptions& options);

/// Whether nothing moves: no velocity and no acceleration.
bool at_rest(const JointState& state);

}  // namespace edgepose
