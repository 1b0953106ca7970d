#include "messaging/transform_message.h"

#include <cmath>

namespace edgepose {
namespace {

constexpr double kMaxNormFault = 1e-6;
constexpr double kMaxTranslation = 1000;  // [m]

}  // namespace

edgepose_lcm::rigid_transform_t to_message(const RigidTransform& transform) {
  Eigen::Quaterniond q(transform.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  edgepose_lcm::rigid_transform_t message{};
  message.quaternion[0] = q.w();
  for (int i = 0; i < 3; ++i) {
    message.quaternion[i + 1] = q.coeffs()[i];
    message.translation[i] = transform.translation()[i];
  }
  return message;
}

std::optional<RigidTransform> from_message(const edgepose_lcm::rigid_transform_t& message) {
  const Eigen::Quaterniond q(message.quaternion[0], message.quaternion[1], message.quaternion[2],
                             message.quaternion[3]);
  const Eigen::Vector3d t(message.translation[0], message.translation[1], message.translation[2]);
  // Written so that a NaN fails.
  if (!(std::abs(q.norm() - 1) <= kMaxNormFault) || !(t.norm() <= kMaxTranslation)) return std::nullopt;
  RigidTransform transform = RigidTransform::Identity();
  transform.linear() = q.normalized().toRotationMatrix();
  transform.translation() = t;
  return transform;
}

}  // namespace edgepose
