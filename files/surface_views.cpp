#include "files/surface_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace edgepose {
namespace {

constexpr int kViews = 12, kSize = 128;

/// Directions spread evenly over the sphere (a Fibonacci lattice).
Eigen::Vector3d view_direction(int i) {
  const double z = 1 - (2 * i + 1.0) / kViews;
  const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Nearest triangle in each pixel. Coordinates in pixels, z towards the viewer.
class DepthBuffer {
 public:
  DepthBuffer() : depth_(kSize * kSize), side_(kSize * kSize) {}

  void clear() {
    std::fill(depth_.begin(), depth_.end(), -std::numeric_limits<double>::infinity());
    std::fill(side_.begin(), side_.end(), 0);
  }

  /// `id` > 0 of the part. The front is seen if the corners run counter-clockwise.
  void draw(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, int64_t id) {
    const Eigen::Vector3d ab = b - a, ac = c - a;
    const double area = ab.x() * ac.y() - ab.y() * ac.x();
    if (area == 0) return;  // on edge
    const int left = first_pixel(std::min({a.x(), b.x(), c.x()})),
              right = last_pixel(std::max({a.x(), b.x(), c.x()}));
    const int low = first_pixel(std::min({a.y(), b.y(), c.y()})),
              high = last_pixel(std::max({a.y(), b.y(), c.y()}));
    const int64_t side = area > 0 ? id : -id;
    // Barycentric weights of b and c grow by these from pixel to pixel.
    const double step_b = ac.y() / area, step_c = -ab.y() / area;
    for (int y = low; y <= high; ++y) {
      const double px = left + 0.5 - a.x(), py = y + 0.5 - a.y();
      double weight_b = (px * ac.y() - py * ac.x()) / area, weight_c = (py * ab.x() - px * ab.y()) / area;
      for (int x = left; x <= right; ++x, weight_b += step_b, weight_c += step_c) {
        if (!(weight_b >= 0 && weight_c >= 0 && weight_b + weight_c <= 1)) continue;
        const double z = a.z() + weight_b * ab.z() + weight_c * ac.z();
        const size_t pixel = static_cast<size_t>(y) * kSize + static_cast<size_t>(x);
        if (z <= depth_[pixel]) continue;
        depth_[pixel] = z;
        side_[pixel] = side;
      }
    }
  }

  void count(std::vector<SeenSides>& seen) const {
    for (const int64_t side : side_) {
      if (side > 0) ++seen[side - 1].front;
      if (side < 0) ++seen[-side - 1].back;
    }
  }

 private:
  // Coordinates lie within the image: the surface was scaled to fit.
  static int first_pixel(double lowest) { return std::max(0, static_cast<int>(std::ceil(lowest - 0.5))); }
  static int last_pixel(double highest) {
    return std::min(kSize - 1, static_cast<int>(std::floor(highest - 0.5)));
  }

  std::vector<double> depth_;
  std::vector<int64_t> side_;  // part + 1, negative: its back; 0: nothing
};

}  // namespace

std::vector<SeenSides> look_from_around(const SurfaceTopology& topology) {
  std::vector<SeenSides> seen(topology.parts.size());
  Eigen::AlignedBox3d box;
  for (const auto& triangle : topology.triangles) {
    for (const uint32_t place : triangle) box.extend(topology.places[place].cast<double>());
  }
  const double radius = topology.triangles.empty() ? 0 : 0.5 * box.diagonal().norm();
  if (!(radius > 0)) return seen;
  const Eigen::Vector3d centre = box.center();
  const double scale = 0.49 * kSize / radius;
  std::vector<Eigen::Vector3d> projected(topology.places.size());
  DepthBuffer buffer;
  for (int view = 0; view < kViews; ++view) {
    const Eigen::Quaterniond viewer_R_model =
        Eigen::Quaterniond::FromTwoVectors(view_direction(view), Eigen::Vector3d::UnitZ());
    const Eigen::Matrix3d rotation = viewer_R_model.toRotationMatrix() * scale;
    for (size_t i = 0; i < projected.size(); ++i) {
      // Places that no triangle uses may lie anywhere; nobody looks at them.
      projected[i] = rotation * (topology.places[i].cast<double>() - centre);
      projected[i].array() += 0.5 * kSize;
    }
    buffer.clear();
    for (size_t t = 0; t < topology.triangles.size(); ++t) {
      auto [a, b, c] = topology.triangles[t];
      if (topology.turn[t]) std::swap(b, c);
      buffer.draw(projected[a], projected[b], projected[c], int64_t{topology.part[t]} + 1);
    }
    buffer.count(seen);
  }
  return seen;
}

}  // namespace edgepose
