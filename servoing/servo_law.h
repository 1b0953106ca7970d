#pragma once
#include <string>

#include "arm/types.h"

namespace edgepose {

/// How far the body (camera or tool) is from its goal.
struct GoalError {
  double translation = 0;  ///< [m]
  double rotation = 0;     ///< [rad] 0 to pi
};

GoalError goal_error(const RigidTransform& goal_T_body);

/// The gain falls from `at_zero` to `at_infinity` as the error grows, so that far away the arm does not rush
/// and close by it does not creep: ViSP's vpAdaptiveGain, l(x) = (l0 - loo) exp(-s x / (l0 - loo)) + loo.
struct AdaptiveGain {
  double at_zero = 1.5;  ///< [1/s] errors shrink by e in 1 / gain seconds; above about 0.5 / (delay of the
                         ///< poses) the loop swings. The three are those of ViSP's servoFrankaPBVS
  double at_infinity = 0.4;   ///< [1/s] at most at_zero
  double slope_at_zero = 30;  ///< [1/s per m or rad] how fast it falls

  double operator()(double error) const;  ///< [1/s] error [m or rad] >= 0: the largest part of it
  std::string check() const;
};

struct ServoCommand {
  Twist body_twist = Twist::Zero();  ///< of the body, in its own frame
  double gain = 0;                   ///< [1/s]
  bool near_half_turn = false;       ///< nothing commanded: which way to turn is not defined
};

/// Rotations from here on [rad] are refused: 170 degrees.
inline constexpr double kHalfTurnGuard = 2.967;

/// Position-based visual servoing (Chaumette and Hutchinson, Visual Servo Control I, 2006, Eq. 14-15 with s =
/// (t, theta u) of goal_T_body): v = -l R^T t, w = -l theta u. The body's origin moves on a straight line to
/// its goal, and its axes turn about one axis. Pure.
ServoCommand servo_command(const RigidTransform& goal_T_body, const AdaptiveGain& gain);

}  // namespace edgepose
