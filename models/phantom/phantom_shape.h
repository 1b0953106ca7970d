#pragma once
#include <Eigen/Core>

/// The vertebra-like phantom as an implicit surface. Millimetres, in the phantom's own frame: x to the
/// patient's left, y to the back (posterior), z to the head; the origin is the middle of the vertebral body.
/// Only + - * / and square roots are used, so that every machine computes the same bits.
namespace edgepose::phantom {

/// Negative inside the bone, positive outside; close to a distance near the surface, but not exactly one.
double signed_distance(const Eigen::Vector3d& point);

/// Unit vector pointing out of the bone at (or near) the surface.
Eigen::Vector3d outward_normal(const Eigen::Vector3d& point);

/// Where the ray from `origin` (outside) along the unit vector `direction` first meets the bone.
/// Throws std::runtime_error if it misses.
Eigen::Vector3d first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// The box that holds the bone, with some room.
inline const Eigen::Vector3d kBoxMin(-50, -24, -32), kBoxMax(52, 72, 30);

}  // namespace edgepose::phantom
