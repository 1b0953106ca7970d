#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "matcher/parallel.h"
#include "render/overlay.h"

namespace edgepose {
namespace {

using Eigen::Vector3d;

bool has_depth(float depth) { return depth > 0 && std::isfinite(depth); }

/// Mean depth of the pixels about (u, v) that lie on the same surface: less noise, the same edges.
float smoothed(const DepthImage& image, int u, int v) {
  const float here = image.at(u, v);
  if (!has_depth(here)) return 0;
  constexpr int kReach = 2;
  const float gate = 0.015f * here;
  float sum = 0, weights = 0;
  for (int y = std::max(0, v - kReach); y <= std::min(image.height - 1, v + kReach); ++y) {
    for (int x = std::max(0, u - kReach); x <= std::min(image.width - 1, u + kReach); ++x) {
      const float difference = std::abs(image.at(x, y) - here) / gate;
      if (!has_depth(image.at(x, y)) || difference >= 1) continue;
      const float weight =
          (1 - difference * difference) / static_cast<float>(1 + (x - u) * (x - u) + (y - v) * (y - v));
      sum += weight * image.at(x, y);
      weights += weight;
    }
  }
  return sum / weights;
}

/// Depths below which 2 % and 98 % of the measurements lie: the ends of the colour scale.
std::pair<float, float> depth_scale(const DepthImage& image) {
  std::vector<float> depths;
  for (const float depth : image.depth) {
    if (has_depth(depth)) depths.push_back(depth);
  }
  if (depths.empty()) return {0.0f, 1.0f};
  const auto rank = [&](size_t percent) {
    const auto nth = depths.begin() + static_cast<std::ptrdiff_t>((depths.size() - 1) * percent / 100);
    std::nth_element(depths.begin(), nth, depths.end());
    return *nth;
  };
  const float low = rank(2), high = rank(98);
  return {low, std::max(high, low * 1.01f)};
}

/// Muted, so that lines in bright colours stand out: near sand, middle grey, far blue.
Vector3d ramp(double nearness) {
  static const Vector3d kColours[] = {{62, 82, 122}, {118, 134, 150}, {196, 188, 170}, {236, 218, 184}};
  const double place = std::clamp(nearness, 0.0, 1.0) * 3;
  const auto below = static_cast<size_t>(std::min(2.0, std::floor(place)));
  const double share = place - static_cast<double>(below);
  return (1 - share) * kColours[below] + share * kColours[below + 1];
}

/// [0, 1] how brightly a lamp a little left of and above the camera lights the surface.
double brightness(const DepthImage& image, const Camera& camera, int u, int v) {
  const auto point = [&](int x, int y) -> Vector3d {
    return Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1) *
           static_cast<double>(image.at(x, y));
  };
  const auto tangent = [&](int du, int dv) -> Vector3d {
    const Vector3d here = point(u, v);
    Vector3d sum = Vector3d::Zero();
    for (const int side : {-1, 1}) {
      const int x = u + side * du, y = v + side * dv;
      if (x < 0 || y < 0 || x >= image.width || y >= image.height || !has_depth(image.at(x, y))) continue;
      if (std::abs(image.at(x, y) - image.at(u, v)) > 0.02f * image.at(u, v)) continue;
      sum += side * (point(x, y) - here);
    }
    return sum;
  };
  const Vector3d normal = tangent(1, 0).cross(tangent(0, 1));
  if (normal.squaredNorm() == 0) return 0.45;
  static const Vector3d kLamp = Vector3d(0.35, 0.45, 0.85).normalized();
  return std::max(0.0, normal.normalized().dot(kLamp));
}

}  // namespace

RgbImage shade_depth(const DepthImage& image, const Camera& camera, int scale) {
  if (image.width < 1 || image.height < 1 ||
      image.depth.size() != static_cast<size_t>(image.width) * static_cast<size_t>(image.height)) {
    throw std::invalid_argument("depth image: expected width * height values");
  }
  if (!(camera.fx > 0 && camera.fy > 0)) throw std::invalid_argument("camera: expected positive fx and fy");
  if (scale < 1 || scale > 16) throw std::invalid_argument("scale: expected 1 to 16");

  DepthImage smooth = image;
  parallel_for(static_cast<size_t>(image.height), 0, [&](size_t row) {
    for (int u = 0; u < image.width; ++u)
      smooth.at(u, static_cast<int>(row)) = smoothed(image, u, static_cast<int>(row));
  });
  const std::pair<float, float> ends = depth_scale(smooth);
  const float near = ends.first, far = ends.second;  // a structured binding is not for capture in clang 14
  cv::Mat shaded(image.height, image.width, CV_8UC3);
  parallel_for(static_cast<size_t>(image.height), 0, [&](size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < image.width; ++u) {
      auto& pixel = shaded.at<cv::Vec3b>(v, u);
      pixel = {14, 15, 18};
      if (!has_depth(smooth.at(u, v))) continue;
      const double nearness = static_cast<double>((far - smooth.at(u, v)) / (far - near));
      const double light = 0.22 + 0.78 * std::pow(brightness(smooth, camera, u, v), 1.3);
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<uint8_t>(ramp(nearness)[c] * light);
    }
  });
  cv::Mat enlarged;
  cv::resize(shaded, enlarged, {}, scale, scale, cv::INTER_LINEAR);
  RgbImage result{enlarged.cols, enlarged.rows, {}};
  result.rgb.assign(enlarged.datastart, enlarged.dataend);
  return result;
}

}  // namespace edgepose
