#pragma once
#include "arm/arm_geometry.h"

namespace edgepose {

/// The pose of the flange at these joint positions [rad]. Pure; any finite positions.
RigidTransform base_T_flange(const ArmGeometry& arm, const JointVector& position);

/// Joint velocities to the twist of the flange: the velocity of its origin and its angular velocity, both in
/// the axes of `base`.
Jacobian flange_jacobian(const ArmGeometry& arm, const JointVector& position);

/// [m/s] velocity, in the axes of `base`, of a point fixed to the flange (`flange_point` [m], flange frame:
/// the tip of the tool).
Eigen::Vector3d point_velocity(const ArmGeometry& arm, const JointVector& position,
                               const JointVector& velocity, const Eigen::Vector3d& flange_point);

/// Largest over smallest singular value (m/s and rad/s count alike, as in MoveIt Servo); infinite where a
/// direction of motion is lost.
double condition_number(const Jacobian& jacobian);

}  // namespace edgepose
