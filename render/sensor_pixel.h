#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "render/pixel_random.h"
#include "render/sensor_model.h"

/// What a sensor makes of one pixel.
namespace edgepose::internal {

// What the random numbers of a pixel are used for.
enum Stream : uint32_t { kWhite, kCorrelated, kFlying, kFlyingShare, kJumpDropout, kDropout, kAngle };

inline bool measured(float depth) { return depth > 0 && std::isfinite(depth); }

/// Direction of the pixel's ray, scaled to z = 1.
inline Eigen::Vector3d ray(const Camera& camera, int u, int v) {
  return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1};
}

/// Nearest and farthest depth in the 3 x 3 pixels about (u, v).
inline std::pair<double, double> depth_range_around(const DepthImage& image, int u, int v) {
  double nearest = image.at(u, v), farthest = nearest;
  for (int y = std::max(0, v - 1); y <= std::min(image.height - 1, v + 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(image.width - 1, u + 1); ++x) {
      if (!measured(image.at(x, y))) continue;
      nearest = std::min(nearest, static_cast<double>(image.at(x, y)));
      farthest = std::max(farthest, static_cast<double>(image.at(x, y)));
    }
  }
  return {nearest, farthest};
}

/// Difference of the surface point to its neighbour on the side where the depth changes less.
inline std::optional<Eigen::Vector3d> tangent(const DepthImage& image, const Camera& camera, int u, int v,
                                              int du, int dv) {
  const double here = image.at(u, v);
  std::optional<Eigen::Vector3d> best;
  double least = std::numeric_limits<double>::infinity();
  for (const int side : {-1, 1}) {
    const int x = u + side * du, y = v + side * dv;
    if (x < 0 || y < 0 || x >= image.width || y >= image.height || !measured(image.at(x, y))) continue;
    const double there = image.at(x, y);
    if (std::abs(there - here) >= least) continue;
    least = std::abs(there - here);
    best = side * (there * ray(camera, x, y) - here * ray(camera, u, v));
  }
  return best;
}

/// [degrees] between the ray and the surface's normal; 0 where no neighbour tells.
inline double incidence_deg(const DepthImage& image, const Camera& camera, int u, int v) {
  const auto right = tangent(image, camera, u, v, 1, 0), down = tangent(image, camera, u, v, 0, 1);
  if (!right || !down) return 0;
  const double cosine = std::abs(right->cross(*down).normalized().dot(ray(camera, u, v).normalized()));
  return std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi;
}

/// Whether the pixel has a measurement at all.
inline bool is_seen(const DepthImage& ideal, const Camera& camera, const SensorModel& sensor, bool at_jump,
                    const PixelRandom& random, int u, int v) {
  if (sensor.dropout > 0 && random.uniform(kDropout) < sensor.dropout) return false;
  if (at_jump && random.uniform(kJumpDropout) < sensor.jump_dropout) return false;
  if (sensor.fading_angle_deg >= 90) return true;
  const double angle = incidence_deg(ideal, camera, u, v);
  if (angle <= sensor.fading_angle_deg) return true;
  const double span = std::max(1e-9, sensor.blind_angle_deg - sensor.fading_angle_deg);
  return random.uniform(kAngle) >= (angle - sensor.fading_angle_deg) / span;
}

/// The depth with the error of the time or disparity measurement; `noise` has unit variance.
inline double with_noise(double depth, const SensorModel& sensor, const Camera& camera, double ray_length,
                         double noise) {
  const double sigma = sensor.noise + sensor.noise_per_square_metre * depth * depth;
  depth += sigma * noise / ray_length;
  if (sensor.baseline > 0) {
    double disparity = camera.fx * sensor.baseline / depth + sensor.disparity_noise * noise;
    if (sensor.disparity_step > 0) {
      disparity = std::round(disparity / sensor.disparity_step) * sensor.disparity_step;
    }
    depth = disparity > 0 ? camera.fx * sensor.baseline / disparity : 0;
  }
  if (sensor.depth_step > 0) depth = std::round(depth / sensor.depth_step) * sensor.depth_step;
  return depth;
}

/// Normal noise of unit variance that neighbouring pixels share: white noise under a Gaussian window. The
/// noise goes on beyond the border, so that the variance is the same everywhere.
std::vector<float> correlated_noise(int width, int height, double radius, uint64_t seed, int threads);

}  // namespace edgepose::internal
