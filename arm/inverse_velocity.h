#pragma once
#include <string>

#include "arm/arm_geometry.h"

namespace edgepose {

/// How joint velocities are found for a twist, and what happens near a singularity.
struct InverseVelocityOptions {
  double slow_condition = 17;  ///< condition number of the Jacobian from which on the arm slows down ...
  double stop_condition = 30;  ///< ... to a stop here (both MoveIt Servo's)
  double leaving_share = 0.1;  ///< (0, 1] of the speed that is left, beyond stop_condition too, for motion
                               ///< that leads away from the singularity: else the arm could never leave.
                               ///< Never more than so much beyond stop_condition: near it joints are fast
  double damping_below = 0.1;  ///< smallest singular value below which the inverse is damped
  double max_damping = 0.05;   ///< at a singularity; more makes joints slower and the twist less exact

  std::string check() const;
};

struct InverseVelocity {
  JointVector velocity = JointVector::Zero();  ///< [rad/s] not yet within the joints' limits
  double condition = 0;                        ///< at this position
  double share = 1;                            ///< of the twist that is made: less than 1 near a singularity
};

/// Joint velocities that give the flange a twist (`base` axes, velocity of the flange's origin): damped least
/// squares, the damping growing from none as the smallest singular value falls (Nakamura and Hanafusa 1986;
/// the form of Chiaverini 1997). Slower where the condition number is high, also on the way out. Pure.
InverseVelocity inverse_velocity(const ArmGeometry& arm, const JointVector& position,
                                 const Twist& flange_twist, const InverseVelocityOptions& options);

}  // namespace edgepose
