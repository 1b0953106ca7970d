#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace edgepose {

/// Largest distance between two of `points` (finite, any unit): found by walking from far point to far point,
/// so never too large and rarely too small by more than 1 %. 0 for fewer than two.
double estimate_diameter(std::span<const Eigen::Vector3f> points);

/// Normal of each vertex: mean of its triangles' normals, weighed by their area; where those cancel out
/// (both sides of a sheet), that of one of them. Zero where there is none. Every index must be valid.
std::vector<Eigen::Vector3f> normals_from_triangles(std::span<const Eigen::Vector3f> vertices,
                                                    std::span<const std::array<uint32_t, 3>> triangles);

}  // namespace edgepose
