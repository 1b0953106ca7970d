#include "servoing/pose_mean.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "arm/rigid_motion.h"

namespace edgepose {

RigidTransform mean_pose(const std::vector<RigidTransform>& poses) {
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  Eigen::Vector3d translations = Eigen::Vector3d::Zero();
  for (const RigidTransform& pose : poses) {
    rotations += pose.linear();
    translations += pose.translation();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotations, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double side = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d mean =
      svd.matrixU() * Eigen::Vector3d(1, 1, side).asDiagonal() * svd.matrixV().transpose();
  return rigid_transform(mean, translations / static_cast<double>(poses.size()));
}

PoseSpread spread(const std::vector<RigidTransform>& poses, const RigidTransform& mean) {
  PoseSpread sum;
  for (const RigidTransform& pose : poses) {
    sum.translation += (pose.translation() - mean.translation()).squaredNorm();
    sum.rotation += rotation_vector(mean.linear().transpose() * pose.linear()).squaredNorm();
  }
  const double count = static_cast<double>(poses.size());
  return {std::sqrt(sum.translation / count), std::sqrt(sum.rotation / count)};
}

}  // namespace edgepose
