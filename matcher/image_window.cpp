#include <algorithm>
#include <cmath>

#include "matcher/model_block.h"
#include "matcher/track.h"

namespace edgepose {
namespace {

constexpr int kLeastSide = 64;  // [pixels] normals, noise and edges need some surroundings

/// [low, high] as whole pixels of [0, size), at least kLeastSide wide where there are so many.
std::pair<int, int> pixels(double low, double high, int size) {
  const double middle = (low + high) / 2, half = std::max((high - low) / 2, kLeastSide / 2.0);
  const double first = std::clamp(std::floor(middle - half), 0.0, static_cast<double>(size));
  const double last = std::clamp(std::ceil(middle + half) + 1, first, static_cast<double>(size));
  return {static_cast<int>(first), static_cast<int>(last)};
}

}  // namespace

ImageWindow window_around(const Model& model, const RigidTransform& camera_T_model, const Camera& camera,
                          int width, int height, float margin) {
  const ModelHeader& header = *model.view().header;
  const double around = static_cast<double>(margin) * model.diameter();
  double u0 = INFINITY, u1 = -INFINITY, v0 = INFINITY, v1 = -INFINITY;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d p;
    for (int i = 0; i < 3; ++i) p[i] = (corner >> i & 1) ? header.box_max[i] : header.box_min[i];
    p = camera_T_model * p;
    if (!(p.z() > 0.01)) return {};
    const double u = camera.fx * p.x() / p.z() + camera.cx, v = camera.fy * p.y() / p.z() + camera.cy;
    const double du = camera.fx * around / p.z(), dv = camera.fy * around / p.z();
    u0 = std::min(u0, u - du), u1 = std::max(u1, u + du);
    v0 = std::min(v0, v - dv), v1 = std::max(v1, v + dv);
  }
  if (u1 < 0 || v1 < 0 || u0 > width - 1 || v0 > height - 1) return {};
  const auto [left, right] = pixels(std::max(u0, 0.0), std::min(u1, width - 1.0), width);
  const auto [top, bottom] = pixels(std::max(v0, 0.0), std::min(v1, height - 1.0), height);
  return {left, top, right - left, bottom - top};
}

ImageWindow united(const ImageWindow& a, const ImageWindow& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int left = std::min(a.left, b.left), top = std::min(a.top, b.top);
  return {left, top, std::max(a.left + a.width, b.left + b.width) - left,
          std::max(a.top + a.height, b.top + b.height) - top};
}

DepthImage cut_out(const DepthImage& image, const ImageWindow& window) {
  DepthImage part{window.width, window.height, {}};
  part.depth.reserve(static_cast<size_t>(window.width) * static_cast<size_t>(window.height));
  for (int v = 0; v < window.height; ++v) {
    const auto row = image.depth.begin() + static_cast<long>(window.top + v) * image.width + window.left;
    part.depth.insert(part.depth.end(), row, row + window.width);
  }
  return part;
}

Camera cut_out(const Camera& camera, const ImageWindow& window) {
  return {camera.fx, camera.fy, camera.cx - window.left, camera.cy - window.top};
}

}  // namespace edgepose
