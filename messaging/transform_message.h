#pragma once
#include <optional>

#include "edgepose_lcm/rigid_transform_t.hpp"
#include "matcher/types.h"

namespace edgepose {

/// As it is sent: a quaternion with w >= 0, and metres.
edgepose_lcm::rigid_transform_t to_message(const RigidTransform& transform);

/// Nothing if a number is not finite, the quaternion's norm is off 1 by more than 1e-6, or the translation
/// is longer than a kilometre.
std::optional<RigidTransform> from_message(const edgepose_lcm::rigid_transform_t& message);

}  // namespace edgepose
