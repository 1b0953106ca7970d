#pragma once
#include <array>

#include "arm/types.h"

namespace edgepose {

/// A serial arm of six revolute joints, each turning about z of its own frame.
struct ArmGeometry {
  std::array<RigidTransform, kJoints> parent_T_joint;  ///< at joint position zero; the first parent is `base`
  JointVector lower, upper;                            ///< [rad] mechanical limits
  JointVector max_velocity;                            ///< [rad/s]
};

/// AUBO i5: the joint origins of the maker's URDF (AuboRobot/aubo_robot, aubo_description), whose pi is
/// rounded to five digits and exact here. The flange is the frame of the sixth joint. Limits +-3.04 rad; 3.14
/// rad/s for joints 1 to 3, 2.6 rad/s for 4 to 6.
ArmGeometry aubo_i5();

}  // namespace edgepose
