#include "client/service/symmetric_error.h"

#include <cmath>

namespace edgepose {
namespace {

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));  // exact for small angles as well
}

/// Against one of the poses that are equal to the truth.
SymmetricError error_against(const Symmetries& symmetries, const RigidTransform& truth,
                             const RigidTransform& estimate) {
  if (symmetries.continuous.empty())
    return {(estimate.translation() - truth.translation()).norm(),
            Eigen::Quaterniond(truth.linear()).angularDistance(Eigen::Quaterniond(estimate.linear()))};
  const SymmetryAxis& axis = symmetries.continuous.front();
  const double turned =
      symmetries.is_sphere() ? 0 : angle(truth.linear() * axis.direction, estimate.linear() * axis.direction);
  return {(estimate * axis.point - truth * axis.point).norm(), turned};
}

}  // namespace

SymmetricError symmetric_error(const Symmetries& symmetries, const RigidTransform& truth,
                               const RigidTransform& estimate) {
  SymmetricError least = error_against(symmetries, truth, estimate);
  for (const RigidTransform& symmetry : symmetries.discrete) {
    const SymmetricError error = error_against(symmetries, truth * symmetry, estimate);
    if (error.rotation < least.rotation) least = error;
  }
  return least;
}

}  // namespace edgepose
