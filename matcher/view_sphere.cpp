#include "matcher/view_sphere.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "matcher/parallel.h"

namespace edgepose {
namespace {

constexpr int kSize = 128;             // pixels a side
constexpr float kPixelsOnModel = 110;  // pixels along the diameter
constexpr float kEmpty = std::numeric_limits<float>::infinity();
constexpr float kSameSurface = 0.025f;  // [d] depth difference within which two points are one surface
constexpr float kJump = 0.05f;          // [d] depth difference that makes an occluding edge

/// Positions, coordinate by coordinate.
struct Columns {
  std::vector<float> x, y, z;
  explicit Columns(const std::vector<OrientedPoint>& points) {
    for (const auto& p : points)
      x.push_back(p.position.x()), y.push_back(p.position.y()), z.push_back(p.position.z());
  }
};

/// An orthographic depth image of the dense samples. Depth grows away from the camera.
class SplatView {
 public:
  SplatView(const Columns& surface, const Eigen::Vector3f& direction, const Eigen::Vector3f& centre,
            float diameter)
      : direction_(direction),
        centre_(centre),
        pixel_(diameter / kPixelsOnModel),
        depth_(kSize * kSize, kEmpty) {
    right_ = direction.unitOrthogonal();
    down_ = direction.cross(right_);
    splat(surface);
    close_holes();
  }

  struct Pixel {
    int u, v;
    float z;
  };
  Pixel project(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f q = p - centre_;
    const auto clamp = [](float x) { return std::clamp(static_cast<int>(std::floor(x)), 1, kSize - 2); };
    return {clamp(q.dot(right_) / pixel_ + kSize / 2.f), clamp(q.dot(down_) / pixel_ + kSize / 2.f),
            -q.dot(direction_)};
  }
  Eigen::Vector3f unproject(int u, int v) const {
    return centre_ + (static_cast<float>(u) + 0.5f - kSize / 2.f) * pixel_ * right_ +
           (static_cast<float>(v) + 0.5f - kSize / 2.f) * pixel_ * down_ - at(u, v) * direction_;
  }
  float at(int u, int v) const { return depth_[static_cast<size_t>(v) * kSize + u]; }
  const Eigen::Vector3f& right() const { return right_; }
  const Eigen::Vector3f& down() const { return down_; }

 private:
  /// project() for all points, in blocks that the compiler vectorises.
  void splat(const Columns& surface) {
    constexpr size_t kBlock = 256;
    std::array<int, kBlock> pixel;
    std::array<float, kBlock> depth;
    const auto clamp = [](float x) {
      return static_cast<int>(std::min(std::max(std::floor(x), 1.f), kSize - 2.f));
    };
    const Eigen::Vector3f c = centre_, r = right_, d = down_, n = direction_;
    const float size = pixel_;
    for (size_t begin = 0; begin < surface.x.size(); begin += kBlock) {
      const size_t count = std::min(kBlock, surface.x.size() - begin);
      const float *x = surface.x.data() + begin, *y = surface.y.data() + begin, *z = surface.z.data() + begin;
      for (size_t i = 0; i < count; ++i) {
        const float qx = x[i] - c[0], qy = y[i] - c[1], qz = z[i] - c[2];
        const float along_r = qx * r[0] + (qy * r[1] + qz * r[2]);
        const float along_d = qx * d[0] + (qy * d[1] + qz * d[2]);
        pixel[i] = clamp(along_d / size + kSize / 2.f) * kSize + clamp(along_r / size + kSize / 2.f);
        depth[i] = -(qx * n[0] + (qy * n[1] + qz * n[2]));
      }
      for (size_t i = 0; i < count; ++i) depth_[pixel[i]] = std::min(depth_[pixel[i]], depth[i]);
    }
  }

  /// Random samples leave single pixels open; a pixel most of whose neighbours are nearer is one of those.
  void close_holes() {
    const std::vector<float> before = depth_;
    for (int v = 1; v + 1 < kSize; ++v)
      for (int u = 1; u + 1 < kSize; ++u) {
        float nearer_sum = 0;
        int nearer = 0;
        const float here = before[static_cast<size_t>(v) * kSize + u];
        for (int dv = -1; dv <= 1; ++dv)
          for (int du = -1; du <= 1; ++du) {
            const float z = before[static_cast<size_t>(v + dv) * kSize + u + du];
            if (z < here - 3 * pixel_) nearer_sum += z, ++nearer;
          }
        if (nearer >= 6) depth_[static_cast<size_t>(v) * kSize + u] = nearer_sum / static_cast<float>(nearer);
      }
  }

  Eigen::Vector3f direction_, right_, down_, centre_;
  float pixel_;
  std::vector<float> depth_;
};

std::vector<bool> visible_points(const SplatView& view, const std::vector<OrientedPoint>& queries,
                                 const Eigen::Vector3f& direction, float diameter) {
  std::vector<bool> visible(queries.size());
  for (size_t i = 0; i < queries.size(); ++i) {
    if (queries[i].normal.dot(direction) < 0.15f) continue;  // edge-on surface is hardly measured
    const auto [u, v, z] = view.project(queries[i].position);
    visible[i] = z < view.at(u, v) + kSameSurface * diameter;
  }
  return visible;
}

std::vector<ContourPoint> outline(const SplatView& view, float diameter, size_t max_points) {
  std::vector<ContourPoint> points;
  if (max_points == 0) return points;
  for (int v = 2; v + 2 < kSize; ++v)
    for (int u = 2; u + 2 < kSize; ++u) {
      const float here = view.at(u, v);
      if (here == kEmpty) continue;
      const auto beyond = [&](int du, int dv) { return view.at(u + du, v + dv) > here + kJump * diameter; };
      if (!beyond(1, 0) && !beyond(-1, 0) && !beyond(0, 1) && !beyond(0, -1)) continue;
      Eigen::Vector2f away = Eigen::Vector2f::Zero();
      for (int dv = -2; dv <= 2; ++dv)
        for (int du = -2; du <= 2; ++du)
          if (beyond(du, dv)) away += Eigen::Vector2f(static_cast<float>(du), static_cast<float>(dv));
      if (away.norm() < 2) continue;  // a speck or a thread one pixel wide: no side is outside
      away.normalize();
      points.push_back({view.unproject(u, v), away.x() * view.right() + away.y() * view.down()});
    }
  if (points.size() <= max_points) return points;
  std::vector<ContourPoint> even;
  for (size_t i = 0; i < max_points; ++i) even.push_back(points[i * points.size() / max_points]);
  return even;
}

}  // namespace

std::vector<Eigen::Vector3f> view_directions(int count) {
  std::vector<Eigen::Vector3f> directions;
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count, r = std::sqrt(1 - z * z), angle = golden_angle * i;
    directions.emplace_back(Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>());
  }
  return directions;
}

std::vector<ViewVisibility> look_from_all_sides(const std::vector<OrientedPoint>& surface,
                                                const std::vector<OrientedPoint>& queries,
                                                const std::vector<Eigen::Vector3f>& directions,
                                                float diameter, size_t max_contour_points, int threads) {
  Eigen::AlignedBox3f box;
  for (const auto& p : surface) box.extend(p.position);
  const Columns columns(surface);
  std::vector<ViewVisibility> views(directions.size());
  parallel_for(directions.size(), threads, [&](size_t i) {
    const SplatView view(columns, directions[i], box.center(), diameter);
    views[i] = {visible_points(view, queries, directions[i], diameter),
                outline(view, diameter, max_contour_points)};
  });
  return views;
}

}  // namespace edgepose
