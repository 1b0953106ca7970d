#include "matcher/pose_comparison.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "matcher/clustering.h"

namespace edgepose {
namespace {

/// The point nearest to `start` that the symmetries leave in place: the box of a tilted cone, say, is not
/// about its axis, and its centre would move with a turn that changes nothing.
Eigen::Vector3d fixed_point(const Symmetries& symmetries, const Eigen::Vector3d& start) {
  if (symmetries.empty()) return start;
  Eigen::Matrix3d a = 1e-6 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const RigidTransform& s : symmetries.discrete) {
    const Eigen::Matrix3d stays = Eigen::Matrix3d::Identity() - s.linear();
    a += stays.transpose() * stays;
    b += stays.transpose() * (s * start - start);
  }
  for (const SymmetryAxis& axis : symmetries.continuous) {
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis.direction * axis.direction.transpose();
    a += across;
    b += across * (axis.point - start);
  }
  return start + a.ldlt().solve(b);
}

}  // namespace

PoseComparison::PoseComparison(const Model& model)
    : diameter_(static_cast<float>(model.diameter())),
      turns_{Eigen::Matrix3f::Identity()},
      any_turn_(model.symmetries().is_sphere()) {
  const Symmetries symmetries = model.symmetries();
  centre_ = fixed_point(symmetries, model.centre()).cast<float>();
  for (const RigidTransform& s : symmetries.discrete) turns_.emplace_back(s.linear().cast<float>());
  for (const SymmetryAxis& axis : symmetries.continuous) axes_.emplace_back(axis.direction.cast<float>());
}

bool PoseComparison::alike(const PoseF& a, const PoseF& b, float distance, float angle) const {
  const float reach = distance * diameter_;
  if ((a * centre_ - b * centre_).squaredNorm() >= reach * reach) return false;
  if (any_turn_) return true;
  return std::any_of(turns_.begin(), turns_.end(), [&](const Eigen::Matrix3f& turn) {
    const Eigen::Matrix3f turned = a.rotation * turn;
    return angle_between(turned, b.rotation) < angle ||
           std::any_of(axes_.begin(), axes_.end(), [&](const Eigen::Vector3f& axis) {
             return (turned * axis).dot(b.rotation * axis) > std::cos(angle);
           });
  });
}

}  // namespace edgepose
