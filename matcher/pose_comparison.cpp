#include "matcher/pose_comparison.h"

#include <algorithm>
#include <cmath>

#include "matcher/clustering.h"

namespace edgepose {

PoseComparison::PoseComparison(const Model& model)
    : diameter_(static_cast<float>(model.diameter())),
      centre_(model.centre().cast<float>()),
      turns_{Eigen::Matrix3f::Identity()} {
  const Symmetries symmetries = model.symmetries();
  for (const RigidTransform& s : symmetries.discrete) turns_.emplace_back(s.linear().cast<float>());
  for (const SymmetryAxis& axis : symmetries.continuous) axes_.emplace_back(axis.direction.cast<float>());
  // Two axes that cross make a sphere.
  for (const Eigen::Vector3f& axis : axes_) any_turn_ |= axis.cross(axes_.front()).norm() > 0.5f;
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
