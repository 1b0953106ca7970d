#pragma once
#include <Eigen/Geometry>
#include <cmath>

#include "arm/types.h"

namespace edgepose {

/// The rotation vector [rad] of a rotation matrix: axis times angle, angle 0 to pi.
inline Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

inline Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-300) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

inline RigidTransform rigid_transform(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  RigidTransform transform = RigidTransform::Identity();
  transform.linear() = rotation;
  transform.translation() = translation;
  return transform;
}

/// [rad] angle of the rotation, 0 to pi.
inline double rotation_angle(const RigidTransform& transform) {
  return rotation_vector(transform.linear()).norm();
}

/// The twist of one rigid body, seen from another of its frames: `source_twist` is the velocity of the origin
/// of `source` and the angular velocity, in the axes of `source`; the result the same of `target`.
inline Twist carried_twist(const RigidTransform& target_T_source, const Twist& source_twist) {
  const Eigen::Vector3d angular = target_T_source.linear() * source_twist.tail<3>();
  Twist twist;
  twist << target_T_source.linear() * source_twist.head<3>() + target_T_source.translation().cross(angular),
      angular;
  return twist;
}

/// The same twist in other axes; the point whose velocity it is stays.
inline Twist turned_twist(const Eigen::Matrix3d& target_R_source, const Twist& source_twist) {
  Twist twist;
  twist << target_R_source * source_twist.head<3>(), target_R_source * source_twist.tail<3>();
  return twist;
}

}  // namespace edgepose
