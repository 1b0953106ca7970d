#pragma once
#include <Eigen/Geometry>
#include <limits>
#include <numbers>
#include <random>

#include "matcher/model.h"

/// Small shapes, random motions and a tiny renderer for the matcher's tests. Metres.
namespace edgepose::fixtures {

/// Reproducible random numbers, the same with every standard library.
class Random {
 public:
  explicit Random(uint64_t seed) : generator_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) * 0x1.0p-53);
  }
  uint64_t below(uint64_t limit) { return generator_() % limit; }
  Eigen::Vector3d vector(double reach) {
    const double x = uniform(-reach, reach), y = uniform(-reach, reach), z = uniform(-reach, reach);
    return {x, y, z};
  }
  Eigen::Vector3d direction() {
    for (;;)
      if (const Eigen::Vector3d v = vector(1); v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
  /// Evenly distributed over all rotations (Shoemake 1992).
  Eigen::Matrix3d rotation() {
    const double a = uniform(0, 1), b = uniform(0, 2 * std::numbers::pi),
                 c = uniform(0, 2 * std::numbers::pi);
    return Eigen::Quaterniond(std::sqrt(1 - a) * std::sin(b), std::sqrt(1 - a) * std::cos(b),
                              std::sqrt(a) * std::sin(c), std::sqrt(a) * std::cos(c))
        .toRotationMatrix();
  }

 private:
  std::mt19937_64 generator_;
};

/// L-shaped bracket with arms of unequal length, about 0.1 m across: no symmetry.
inline Mesh bracket() {
  constexpr float kLong = 0.08f, kShort = 0.05f, kThick = 0.02f, kWidth = 0.04f;
  const std::vector<Eigen::Vector2f> outline = {{0, 0},           {kLong, 0},       {kLong, kThick},
                                                {kThick, kThick}, {kThick, kShort}, {0, kShort}};
  Mesh mesh;
  for (float z : {0.f, kWidth})
    for (const auto& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  for (uint32_t i = 0; i < 6; ++i) {
    const uint32_t next = (i + 1) % 6;
    mesh.triangles.push_back({i, next, next + 6});
    mesh.triangles.push_back({i, next + 6, i + 6});
  }
  // The inner corner (3) sees the whole outline.
  const std::vector<std::array<uint32_t, 3>> cap = {{3, 4, 5}, {3, 5, 0}, {3, 0, 1}, {3, 1, 2}};
  for (const auto& t : cap) {
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
    mesh.triangles.push_back({t[0], t[2], t[1]});
  }
  return mesh;
}

inline TrainOptions quick_training(int threads = 0) {
  TrainOptions options;
  options.views = 60;
  options.threads = threads;
  return options;
}

/// Trained once for all tests.
inline const Model& bracket_model() {
  static const Model model = train_model(bracket(), "bracket", quick_training());
  return model;
}

constexpr Camera kCamera{250, 250, 99.5, 79.5};
constexpr int kWidth = 200, kHeight = 160;

/// A plane n.X = offset, camera frame.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

inline Eigen::Vector3d ray(int u, int v) {
  return {(u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1};
}

/// Depth at which a ray meets a triangle (Moeller and Trumbore), infinite if it does not.
inline double meet(const Eigen::Vector3d& ray, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d e1 = b - a, e2 = c - a, p = ray.cross(e2);
  const double determinant = e1.dot(p);
  if (std::abs(determinant) < 1e-15) return kMiss;
  const Eigen::Vector3d q = (-a).cross(e1);
  const double s = -a.dot(p) / determinant, t = ray.dot(q) / determinant, depth = e2.dot(q) / determinant;
  return s >= 0 && t >= 0 && s + t <= 1 && depth > 0 ? depth : kMiss;
}

/// Depth image of a plane and, in front of it, posed meshes.
inline DepthImage render(const Plane& plane, const Mesh& mesh = {},
                         const RigidTransform& camera_T_model = RigidTransform::Identity()) {
  std::vector<Eigen::Vector3d> vertices;
  for (const auto& p : mesh.vertices) vertices.push_back(camera_T_model * p.cast<double>());
  DepthImage image{kWidth, kHeight, std::vector<float>(size_t{kWidth} * kHeight, 0.f)};
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d r = ray(u, v);
      double depth = plane.offset / plane.normal.dot(r);
      if (!(depth > 0)) depth = std::numeric_limits<double>::infinity();
      for (const auto& t : mesh.triangles)
        depth = std::min(depth, meet(r, vertices[t[0]], vertices[t[1]], vertices[t[2]]));
      if (depth < 5) image.at(u, v) = static_cast<float>(depth);
    }
  return image;
}

/// A table half a metre or less in front of the camera, seen at 35 degrees from above.
inline Plane table() {
  const Eigen::Vector3d up = Eigen::Vector3d(0, -std::sin(0.6), -std::cos(0.6));
  return {up, up.dot(Eigen::Vector3d(0, 0, 0.34))};
}

/// Turns the mesh at random and sets it down on the table in the middle of the image.
inline RigidTransform pose_on_table(const Mesh& mesh, const Plane& plane, Random& random) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = random.rotation();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& p : mesh.vertices)
    centre += pose * p.cast<double>() / static_cast<double>(mesh.vertices.size());
  const double x = random.uniform(-0.02, 0.02), y = random.uniform(-0.02, 0.02);
  pose.translation() = Eigen::Vector3d(x, y, 0.3) - centre;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& p : mesh.vertices)
    lowest = std::min(lowest, plane.normal.dot(pose * p.cast<double>()) - plane.offset);
  pose.translation() -= lowest * plane.normal;
  return pose;
}

}  // namespace edgepose::fixtures
