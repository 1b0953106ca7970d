#include "arm/kinematics.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

namespace edgepose {
namespace {

/// The frames of all joints, turned; the last is the flange's.
std::array<RigidTransform, kJoints> joint_frames(const ArmGeometry& arm, const JointVector& position) {
  std::array<RigidTransform, kJoints> frames;
  RigidTransform base_T_joint = RigidTransform::Identity();
  for (int i = 0; i < kJoints; ++i) {
    base_T_joint = base_T_joint * arm.parent_T_joint[i];
    const double c = std::cos(position[i]), s = std::sin(position[i]);
    const Eigen::Vector3d x = base_T_joint.linear().col(0), y = base_T_joint.linear().col(1);
    base_T_joint.linear().col(0) = c * x + s * y;  // a turn about z
    base_T_joint.linear().col(1) = c * y - s * x;
    frames[i] = base_T_joint;
  }
  return frames;
}

}  // namespace

RigidTransform base_T_flange(const ArmGeometry& arm, const JointVector& position) {
  return joint_frames(arm, position).back();
}

Jacobian flange_jacobian(const ArmGeometry& arm, const JointVector& position) {
  const auto frames = joint_frames(arm, position);
  Jacobian jacobian;
  for (int i = 0; i < kJoints; ++i) {
    const Eigen::Vector3d axis = frames[i].linear().col(2);
    const Eigen::Vector3d lever = frames.back().translation() - frames[i].translation();
    jacobian.col(i) << axis.cross(lever), axis;
  }
  return jacobian;
}

Eigen::Vector3d point_velocity(const ArmGeometry& arm, const JointVector& position,
                               const JointVector& velocity, const Eigen::Vector3d& flange_point) {
  const auto frames = joint_frames(arm, position);
  const Eigen::Vector3d point = frames.back() * flange_point;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < kJoints; ++i)
    sum += velocity[i] * frames[i].linear().col(2).cross(point - frames[i].translation());
  return sum;
}

double condition_number(const Jacobian& jacobian) {
  const Eigen::JacobiSVD<Jacobian> svd(jacobian);
  const double smallest = svd.singularValues()[kJoints - 1];
  return smallest > 0 ? svd.singularValues()[0] / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace edgepose
