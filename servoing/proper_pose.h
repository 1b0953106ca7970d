#pragma once
#include <Eigen/LU>

#include "arm/types.h"

namespace edgepose {

/// Whether the numbers are finite, the matrix a rotation (to 1e-6) and the translation within 100 m.
inline bool is_proper(const RigidTransform& pose) {
  const Eigen::Matrix3d rotation = pose.linear();
  return pose.matrix().allFinite() && pose.translation().norm() < 100 && rotation.determinant() > 0 &&
         (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < 1e-6;
}

}  // namespace edgepose
