#pragma once
#include <cmath>
#include <numbers>

#include "matcher/types.h"

/// Simple meshes whose depth is known in closed form. Metres.
namespace edgepose::shapes {

/// Rectangle in the plane z = 0, facing -z, corners at (+-half_width, +-half_height).
inline Mesh rectangle(float half_width, float half_height) {
  Mesh mesh;
  mesh.vertices = {{-half_width, -half_height, 0},
                   {half_width, -half_height, 0},
                   {half_width, half_height, 0},
                   {-half_width, half_height, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

/// Sphere about the origin, fine enough to be within radius * (pi / rings)^2 / 2 of the true one.
inline Mesh sphere(float radius, int rings) {
  Mesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    const double polar = std::numbers::pi * i / rings;
    for (int j = 0; j < columns; ++j) {
      const double turn = 2 * std::numbers::pi * j / columns;
      const Eigen::Vector3d out(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                                std::cos(polar));
      mesh.vertices.emplace_back(out.cast<float>() * radius);
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < columns; ++j) {
      const auto a = static_cast<uint32_t>(i * columns + j),
                 b = static_cast<uint32_t>(i * columns + (j + 1) % columns);
      const auto c = a + static_cast<uint32_t>(columns), d = b + static_cast<uint32_t>(columns);
      if (i > 0) mesh.triangles.push_back({a, c, b});
      if (i < rings - 1) mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

/// Axis-aligned box about the origin with outward triangles and shared corners.
inline Mesh box(float half_x, float half_y, float half_z) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? half_x : -half_x, i & 2 ? half_y : -half_y, i & 4 ? half_z : -half_z);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline RigidTransform at(double x, double y, double z) {
  return RigidTransform(Eigen::Translation3d(x, y, z));
}

}  // namespace edgepose::shapes
