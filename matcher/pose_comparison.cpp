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
}

bool PoseComparison::alike(const PoseF& a, const PoseF& b, float distance, float angle) const {
  const float reach = distance * diameter_;
  if ((a * centre_ - b * centre_).squaredNorm() >= reach * reach) return false;
  const auto like_turned = [&](const Eigen::Matrix3f& turn) {
    return angle_between(a.rotation * turn, b.rotation) < angle;
  };
  const auto like_about = [&](const Eigen::Vector3f& axis) {
    return (a.rotation * axis).dot(b.rotation * axis) > std::cos(angle);
  };
  return std::any_of(turns_.begin(), turns_.end(), like_turned) ||
         std::any_of(axes_.begin(), axes_.end(), like_about);
}

}  // namespace edgepose
