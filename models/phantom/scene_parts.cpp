#include "models/phantom/scene_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/pixel_random.h"

namespace edgepose::phantom {
namespace {

using Eigen::Vector3d;

double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Smooth random bumps about 1 high and 1 wide, by interpolating random values on a grid.
double bumps(double x, double y, uint64_t seed) {
  const double column = std::floor(x), row = std::floor(y);
  const auto value = [&](int dx, int dy) {
    return internal::PixelRandom(seed, static_cast<int>(column) + dx, static_cast<int>(row) + dy).uniform(0);
  };
  const double across = smooth_step(x - column), along = smooth_step(y - row);
  const double near = (1 - across) * value(0, 0) + across * value(1, 0);
  const double far = (1 - across) * value(0, 1) + across * value(1, 1);
  return (1 - along) * near + along * far - 0.5;
}

}  // namespace

Mesh box(const Vector3d& low, const Vector3d& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
    mesh.vertices.emplace_back(corner.cast<float>());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh rod(const std::vector<Vector3d>& points, const std::vector<double>& radii) {
  constexpr uint32_t kSides = 24;
  Mesh mesh;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vector3d along =
        (points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1]).normalized();
    Vector3d across = along.cross(Vector3d(0.3, 0.2, 0.93));
    across.normalize();
    const Vector3d third = along.cross(across);
    for (uint32_t side = 0; side < kSides; ++side) {
      const double turn = 2 * std::numbers::pi * side / kSides;
      const Vector3d out = std::cos(turn) * across + std::sin(turn) * third;
      mesh.vertices.emplace_back(Vector3d(points[i] + radii[i] * out).cast<float>());
    }
  }
  const auto rings = static_cast<uint32_t>(points.size());
  for (uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (uint32_t side = 0; side < kSides; ++side) {
      const uint32_t a = ring * kSides + side, b = ring * kSides + (side + 1) % kSides;
      mesh.triangles.push_back({a, b, a + kSides});
      mesh.triangles.push_back({b, b + kSides, a + kSides});
    }
  }
  for (uint32_t side = 1; side + 1 < kSides; ++side) {  // flat ends
    mesh.triangles.push_back({0, side + 1, side});
    const uint32_t last = (rings - 1) * kSides;
    mesh.triangles.push_back({last, last + side, last + side + 1});
  }
  return mesh;
}

Mesh tissue(const Tissue& t) {
  constexpr double kStep = 0.0025, kHalfX = 0.17, kHalfY = 0.15;  // [m]
  const int columns = static_cast<int>(2 * kHalfX / kStep) + 1,
            rows = static_cast<int>(2 * kHalfY / kStep) + 1;
  Mesh mesh;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = -kHalfX + column * kStep, y = -kHalfY + row * kStep;
      const double to_border = 1 - std::sqrt(std::sqrt(std::pow(x / kHalfX, 4) + std::pow(y / kHalfY, 4)));
      // 1 on the border of the opening; its walls are about 8 mm wide.
      const double ring = std::hypot(x / t.opening_x, y / t.opening_y);
      const double wall = smooth_step((ring - 1) * t.opening_x / 0.008);
      const double rough =
          t.bumps * (2 * bumps(x / 0.022, y / 0.022, t.seed) + bumps(x / 0.008, y / 0.008, t.seed + 1));
      const double top = t.floor + wall * (t.height - t.floor) + rough;
      mesh.vertices.emplace_back(Vector3d(x, y, top * smooth_step(to_border / 0.55) - 0.001).cast<float>());
    }
  }
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<uint32_t>(row * columns + column), b = a + static_cast<uint32_t>(columns);
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({a + 1, b + 1, b});
    }
  }
  return mesh;
}

}  // namespace edgepose::phantom
