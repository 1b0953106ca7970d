#pragma once
#include <algorithm>

#include "matcher/surface_sampling.h"
#include "tests/matcher/fixtures.h"

/// Solids whose symmetries are known, for the matcher's tests. Metres, about the origin unless moved.
namespace edgepose::fixtures {

/// The convex hull of points none of which lies inside it; slow, for a few dozen points.
inline Mesh convex_hull(const std::vector<Eigen::Vector3d>& points) {
  Mesh mesh;
  for (const auto& p : points) mesh.vertices.push_back(p.cast<float>());
  for (uint32_t a = 0; a < points.size(); ++a)
    for (uint32_t b = a + 1; b < points.size(); ++b)
      for (uint32_t c = b + 1; c < points.size(); ++c) {
        const Eigen::Vector3d normal = (points[b] - points[a]).cross(points[c] - points[a]);
        std::vector<uint32_t> face;
        bool above = false, below = false;
        for (uint32_t i = 0; i < points.size(); ++i) {
          const double side = normal.dot(points[i] - points[a]) / normal.norm();
          (side > 1e-9 ? above : below) |= std::abs(side) > 1e-9;
          if (std::abs(side) <= 1e-9) face.push_back(i);
        }
        // A face of more than three corners turns up for each three of them: only its first three build it.
        if ((above && below) || face[0] != a || face[1] != b || face[2] != c) continue;
        const Eigen::Vector3d out = (above ? -normal : normal).normalized(), x = out.unitOrthogonal();
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (uint32_t i : face) middle += points[i] / static_cast<double>(face.size());
        const auto turn = [&](uint32_t i) {
          const Eigen::Vector3d d = points[i] - middle;
          return std::atan2(out.cross(x).dot(d), x.dot(d));
        };
        std::sort(face.begin(), face.end(), [&](uint32_t i, uint32_t k) { return turn(i) < turn(k); });
        for (size_t k = 2; k < face.size(); ++k) mesh.triangles.push_back({face[0], face[k - 1], face[k]});
      }
  return mesh;
}

/// A prism with a regular polygon as its base, or (`top` below 1) a frustum of the pyramid on it.
inline Mesh prism(int sides, double radius, double height, double top = 1) {
  std::vector<Eigen::Vector3d> corners;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < sides; ++i) {
      const double turn = 2 * std::numbers::pi * i / sides, r = end ? top * radius : radius;
      corners.emplace_back(r * std::cos(turn), r * std::sin(turn), (end - 0.5) * height);
    }
  return convex_hull(corners);
}

inline Mesh box(double x, double y, double z) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? x / 2 : -x / 2, i & 2 ? y / 2 : -y / 2, i & 4 ? z / 2 : -z / 2);
  return convex_hull(corners);
}

inline Mesh tetrahedron() {
  return convex_hull({{0.04, 0.04, 0.04}, {0.04, -0.04, -0.04}, {-0.04, 0.04, -0.04}, {-0.04, -0.04, 0.04}});
}

inline Mesh octahedron() {
  return convex_hull({{0.05, 0, 0}, {-0.05, 0, 0}, {0, 0.05, 0}, {0, -0.05, 0}, {0, 0, 0.05}, {0, 0, -0.05}});
}

inline Mesh icosahedron() {
  const double a = 0.03, b = a * std::numbers::phi;
  std::vector<Eigen::Vector3d> corners;
  for (double s : {-a, a})
    for (double t : {-b, b}) {
      corners.emplace_back(0, s, t);
      corners.emplace_back(s, t, 0);
      corners.emplace_back(t, 0, s);
    }
  return convex_hull(corners);
}

/// A surface of revolution about z: `outline` as (radius, height) from bottom to top.
inline Mesh lathe(const std::vector<Eigen::Vector2d>& outline, uint32_t segments = 180) {
  Mesh mesh;
  for (const auto& p : outline)
    for (uint32_t i = 0; i < segments; ++i) {
      const double turn = 2 * std::numbers::pi * i / segments;
      mesh.vertices.push_back(
          Eigen::Vector3d(p.x() * std::cos(turn), p.x() * std::sin(turn), p.y()).cast<float>());
    }
  for (uint32_t k = 1; k < outline.size(); ++k)
    for (uint32_t i = 0; i < segments; ++i) {
      const uint32_t next = (i + 1) % segments, low = (k - 1) * segments, high = k * segments;
      mesh.triangles.push_back({low + i, low + next, high + next});
      mesh.triangles.push_back({low + i, high + next, high + i});
    }
  return mesh;
}

inline Mesh cylinder(double radius, double height) {
  return lathe({{0, -height / 2}, {radius, -height / 2}, {radius, height / 2}, {0, height / 2}});
}

inline Mesh sphere(double radius) {
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i <= 60; ++i) {
    const double angle = std::numbers::pi * (i / 60.0 - 0.5);
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return lathe(outline);
}

/// A wheel with rectangular teeth; `thick`: its thickness as a share of the radius.
inline Mesh gear(int teeth, double radius, double thickness) {
  Mesh mesh;
  const auto n = static_cast<uint32_t>(4 * teeth);
  for (double z : {-thickness / 2, thickness / 2}) {
    for (uint32_t i = 0; i < n; ++i) {
      const double turn = 2 * std::numbers::pi * (i / 2 + (i % 2 ? 0.45 : -0.45)) / (2 * teeth);
      const double r = i / 2 % 2 ? 0.85 * radius : radius;
      mesh.vertices.push_back(Eigen::Vector3d(r * std::cos(turn), r * std::sin(turn), z).cast<float>());
    }
    mesh.vertices.push_back(Eigen::Vector3f(0, 0, static_cast<float>(z)));
  }
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t next = (i + 1) % n, up = n + 1;
    mesh.triangles.push_back({i, next, next + up});
    mesh.triangles.push_back({i, next + up, i + up});
    mesh.triangles.push_back({n, next, i});
    mesh.triangles.push_back({n + up, i + up, next + up});
  }
  return mesh;
}

inline Mesh moved(Mesh mesh, const RigidTransform& motion) {
  for (auto& p : mesh.vertices) p = (motion * p.cast<double>()).cast<float>();
  return mesh;
}

}  // namespace edgepose::fixtures
