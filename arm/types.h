#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "matcher/types.h"

/// Units: metres, radians, seconds. Frames: `base` (the arm's foot), `flange` (its last link), `tool` (tip of
/// the drill, z forward along it), `camera`, `model`; docs/servoing.md draws the chain.
namespace edgepose {

inline constexpr int kJoints = 6;

using JointVector =
    Eigen::Matrix<double, kJoints, 1>;               ///< [rad], [rad/s], ...: one value a joint, base first
using Twist = Eigen::Matrix<double, 6, 1>;           ///< linear [m/s], then angular [rad/s]
using Jacobian = Eigen::Matrix<double, 6, kJoints>;  ///< joint velocities to a Twist

/// Where the commanded motion is. All zero is an arm at rest in its zero position.
struct JointState {
  JointVector position = JointVector::Zero();      ///< [rad]
  JointVector velocity = JointVector::Zero();      ///< [rad/s]
  JointVector acceleration = JointVector::Zero();  ///< [rad/s^2]
};

}  // namespace edgepose
