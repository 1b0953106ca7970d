#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "matcher/scene.h"

namespace edgepose {
namespace {

constexpr float kFieldOfView = 1.2f;  // tangent of half the widest angle that is projected
constexpr int kMaxSide = 1200;        // pixels

/// Coordinates of the points in the frame of the virtual camera.
std::vector<Eigen::Vector3f> to_camera(const std::vector<Eigen::Vector3f>& points,
                                       const RigidTransform& cloud_T_camera) {
  const Eigen::Isometry3f camera_T_cloud = cloud_T_camera.inverse().cast<float>();
  std::vector<Eigen::Vector3f> seen;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3f q = camera_T_cloud * p;
    if (q.allFinite() && q.z() > 1e-3f && std::abs(q.x()) < kFieldOfView * q.z() &&
        std::abs(q.y()) < kFieldOfView * q.z())
      seen.push_back(q);
  }
  return seen;
}

/// Closes single open pixels between measured ones, which a resampled scan has.
void close_pinholes(DepthImage& image) {
  const DepthImage before = image;
  for (int v = 1; v + 1 < image.height; ++v)
    for (int u = 1; u + 1 < image.width; ++u) {
      if (before.at(u, v) > 0) continue;
      float sum = 0, low = 1e9f, high = 0;
      int count = 0;
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du)
          if (const float z = before.at(u + du, v + dv); z > 0)
            sum += z, ++count, low = std::min(low, z), high = std::max(high, z);
      if (count >= 4 && high < 1.02f * low) image.at(u, v) = sum / static_cast<float>(count);
    }
}

}  // namespace

ProjectedCloud project_cloud(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& viewpoint) {
  std::array<std::vector<float>, 3> coordinates;
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite())
      for (int axis = 0; axis < 3; ++axis) coordinates[static_cast<size_t>(axis)].push_back(p[axis]);
  if (coordinates[0].size() < 100)
    throw std::invalid_argument("scene cloud: expected at least 100 finite points, found " +
                                std::to_string(coordinates[0].size()));
  Eigen::Vector3f median;
  for (int axis = 0; axis < 3; ++axis) {
    auto& c = coordinates[static_cast<size_t>(axis)];
    std::nth_element(c.begin(), c.begin() + static_cast<long>(c.size() / 2), c.end());
    median[axis] = c[c.size() / 2];
  }
  const Eigen::Vector3d forward = (median - viewpoint).cast<double>();
  if (!(forward.norm() > 1e-3))
    throw std::invalid_argument(
        "scene cloud: expected a viewpoint in front of the cloud, found it in its middle; give another "
        "viewpoint");

  ProjectedCloud projected;
  projected.cloud_T_camera = RigidTransform::Identity();
  const Eigen::Vector3d z = forward.normalized();
  const Eigen::Vector3d down = std::abs(z.y()) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d x = down.cross(z).normalized();
  projected.cloud_T_camera.linear() << x, z.cross(x), z;
  projected.cloud_T_camera.translation() = viewpoint.cast<double>();

  const auto seen = to_camera(points, projected.cloud_T_camera);
  if (seen.size() < 100)
    throw std::invalid_argument(
        "scene cloud: expected at least 100 points within 50 degrees of the line of sight, found " +
        std::to_string(seen.size()) + "; give another viewpoint");
  Eigen::AlignedBox2f box;
  for (const auto& p : seen) box.extend(Eigen::Vector2f(p.x() / p.z(), p.y() / p.z()));
  // About one point a pixel: a scan covers perhaps half of its bounding box.
  const double area = std::max(1e-6, static_cast<double>(box.sizes().x()) * box.sizes().y());
  double pixels_a_unit = std::sqrt(static_cast<double>(seen.size()) / area) * 1.1;
  pixels_a_unit =
      std::min(pixels_a_unit, kMaxSide / std::max(1e-3, static_cast<double>(box.sizes().maxCoeff())));
  projected.camera = {pixels_a_unit, pixels_a_unit, 2 - box.min().x() * pixels_a_unit,
                      2 - box.min().y() * pixels_a_unit};
  projected.image.width = std::max(16, static_cast<int>(box.sizes().x() * pixels_a_unit) + 5);
  projected.image.height = std::max(16, static_cast<int>(box.sizes().y() * pixels_a_unit) + 5);
  projected.image.depth.assign(static_cast<size_t>(projected.image.width) * projected.image.height, 0.f);
  for (const auto& p : seen) {
    const int u = static_cast<int>(std::lround(p.x() / p.z() * pixels_a_unit + projected.camera.cx));
    const int v = static_cast<int>(std::lround(p.y() / p.z() * pixels_a_unit + projected.camera.cy));
    if (u < 0 || v < 0 || u >= projected.image.width || v >= projected.image.height) continue;
    float& depth = projected.image.at(u, v);
    if (depth <= 0 || p.z() < depth) depth = p.z();
  }
  close_pinholes(projected.image);
  return projected;
}

}  // namespace edgepose
