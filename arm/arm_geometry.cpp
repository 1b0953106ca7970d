#include "arm/arm_geometry.h"

#include <numbers>

#include "arm/rigid_motion.h"

namespace edgepose {
namespace {

/// As URDF's <origin>: roll, pitch, yaw about the fixed axes x, y, z.
RigidTransform origin(const Eigen::Vector3d& xyz, double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Matrix3d rotation =
      (AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
       AngleAxisd(roll, Vector3d::UnitX()))
          .toRotationMatrix();
  return rigid_transform(rotation, xyz);
}

}  // namespace

ArmGeometry aubo_i5() {
  constexpr double kPi = std::numbers::pi;
  ArmGeometry arm;
  arm.parent_T_joint = {
      origin({0, 0, 0.122}, 0, 0, kPi),       origin({0, 0.1215, 0}, -kPi / 2, -kPi / 2, 0),
      origin({0.408, 0, 0}, -kPi, 0, 0),      origin({0.376, 0, 0}, kPi, 0, kPi / 2),
      origin({0, 0.1025, 0}, -kPi / 2, 0, 0), origin({0, -0.094, 0}, kPi / 2, 0, 0),
  };
  arm.upper.setConstant(3.04);
  arm.lower = -arm.upper;
  arm.max_velocity << 3.14, 3.14, 3.14, 2.6, 2.6, 2.6;
  return arm;
}

}  // namespace edgepose
