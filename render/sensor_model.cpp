#include "render/sensor_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "matcher/parallel.h"
#include "render/pixel_random.h"

namespace edgepose {
namespace {

using internal::PixelRandom;

// What the random numbers of a pixel are used for.
enum Stream : uint32_t { kWhite, kCorrelated, kFlying, kFlyingShare, kJumpDropout, kDropout, kAngle };

void require_sound(const DepthImage& image, const Camera& camera) {
  if (image.width < 1 || image.height < 1 ||
      image.depth.size() != static_cast<size_t>(image.width) * static_cast<size_t>(image.height)) {
    throw std::invalid_argument("depth image: expected width * height values, found " +
                                std::to_string(image.depth.size()) + " for " + std::to_string(image.width) +
                                "x" + std::to_string(image.height));
  }
  if (!(camera.fx > 0 && camera.fy > 0 && std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy))) {
    throw std::invalid_argument("camera: expected finite numbers with positive fx and fy");
  }
}

bool measured(float depth) { return depth > 0 && std::isfinite(depth); }

/// Direction of the pixel's ray, scaled to z = 1.
Eigen::Vector3d ray(const Camera& camera, int u, int v) {
  return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1};
}

/// Normal noise of unit variance that neighbouring pixels share: white noise under a Gaussian window. The
/// noise goes on beyond the border, so that the variance is the same everywhere.
std::vector<float> correlated_noise(int width, int height, double radius, uint64_t seed, int threads) {
  const int reach = static_cast<int>(std::ceil(3 * radius));
  std::vector<double> window(2 * reach + 1);
  double squares = 0;
  for (int i = -reach; i <= reach; ++i) {
    window[i + reach] = std::exp(-0.5 * i * i / (radius * radius));
    squares += window[i + reach] * window[i + reach];
  }
  for (double& weight : window) weight /= std::sqrt(squares);

  const size_t padded_height = height + 2 * reach, columns = width;
  std::vector<float> across(padded_height * columns), result(static_cast<size_t>(height) * columns);
  parallel_for(padded_height, threads, [&](size_t line) {
    const int row = static_cast<int>(line);
    std::vector<double> white(columns + static_cast<size_t>(2 * reach));
    for (int u = -reach; u < width + reach; ++u) {
      white[u + reach] = PixelRandom(seed, u, row - reach).normal(kCorrelated);
    }
    for (size_t u = 0; u < columns; ++u) {
      double sum = 0;
      for (size_t i = 0; i < window.size(); ++i) sum += window[i] * white[u + i];
      across[static_cast<size_t>(row) * columns + u] = static_cast<float>(sum);
    }
  });
  parallel_for(static_cast<size_t>(height), threads, [&](size_t line) {
    const int row = static_cast<int>(line);
    for (size_t u = 0; u < columns; ++u) {
      double sum = 0;
      for (size_t i = 0; i < window.size(); ++i) {
        sum += window[i] * static_cast<double>(across[(static_cast<size_t>(row) + i) * columns + u]);
      }
      result[static_cast<size_t>(row) * columns + u] = static_cast<float>(sum);
    }
  });
  return result;
}

/// Which pixels of row v the projector does not light. It stands to the right, so an occluder lies to the
/// right too: seen from the projector, columns must rise from left to right.
std::vector<bool> projector_shadow(const DepthImage& image, const Camera& camera, double baseline, int v) {
  std::vector<bool> shadow(static_cast<size_t>(image.width), false);
  double leftmost = std::numeric_limits<double>::infinity();
  for (int u = image.width - 1; u >= 0; --u) {
    const float depth = image.at(u, v);
    if (!measured(depth)) continue;
    const double column = u - camera.fx * baseline / static_cast<double>(depth);
    if (column >= leftmost) shadow[static_cast<size_t>(u)] = true;
    leftmost = std::min(leftmost, column);
  }
  return shadow;
}

/// Nearest and farthest depth in the 3 x 3 pixels about (u, v).
std::pair<double, double> depth_range_around(const DepthImage& image, int u, int v) {
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
std::optional<Eigen::Vector3d> tangent(const DepthImage& image, const Camera& camera, int u, int v, int du,
                                       int dv) {
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
double incidence_deg(const DepthImage& image, const Camera& camera, int u, int v) {
  const auto right = tangent(image, camera, u, v, 1, 0), down = tangent(image, camera, u, v, 0, 1);
  if (!right || !down) return 0;
  const double cosine = std::abs(right->cross(*down).normalized().dot(ray(camera, u, v).normalized()));
  return std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi;
}

/// Whether the pixel has a measurement at all.
bool is_seen(const DepthImage& ideal, const Camera& camera, const SensorModel& sensor, bool at_jump,
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
double with_noise(double depth, const SensorModel& sensor, const Camera& camera, double ray_length,
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

}  // namespace

DepthImage apply_sensor(const DepthImage& ideal, const Camera& camera, const SensorModel& sensor,
                        uint64_t seed, int threads) {
  require_sound(ideal, camera);
  if (const std::string fault = sensor.check(); !fault.empty()) throw std::invalid_argument(fault);

  std::vector<float> shared;
  if (sensor.correlated_share > 0) {
    shared = correlated_noise(ideal.width, ideal.height, sensor.correlation_radius, seed, threads);
  }
  const double white_weight = std::sqrt(1 - sensor.correlated_share);
  const double shared_weight = std::sqrt(sensor.correlated_share);

  DepthImage result{ideal.width, ideal.height, std::vector<float>(ideal.depth.size(), 0.0f)};
  parallel_for(static_cast<size_t>(ideal.height), threads, [&](size_t line) {
    const int v = static_cast<int>(line);
    std::vector<bool> shadow(static_cast<size_t>(ideal.width), false);
    if (sensor.baseline > 0) shadow = projector_shadow(ideal, camera, sensor.baseline, v);
    for (int u = 0; u < ideal.width; ++u) {
      if (!measured(ideal.at(u, v)) || shadow[static_cast<size_t>(u)]) continue;
      const PixelRandom random(seed, u, v);
      double depth = ideal.at(u, v);
      const auto [nearest, farthest] = depth_range_around(ideal, u, v);
      const bool at_jump = farthest - nearest > sensor.jump_threshold * nearest;
      if (!is_seen(ideal, camera, sensor, at_jump, random, u, v)) continue;
      if (at_jump && random.uniform(kFlying) < sensor.flying_pixels) {
        depth = nearest + random.uniform(kFlyingShare) * (farthest - nearest);
      }
      double noise = white_weight * random.normal(kWhite);
      if (!shared.empty()) {
        noise +=
            shared_weight *
            static_cast<double>(
                shared[static_cast<size_t>(v) * static_cast<size_t>(ideal.width) + static_cast<size_t>(u)]);
      }
      depth = with_noise(depth, sensor, camera, ray(camera, u, v).norm(), noise);
      if (depth > 0 && depth >= sensor.min_depth && depth <= sensor.max_depth) {
        result.at(u, v) = static_cast<float>(depth);
      }
    }
  });
  return result;
}

DepthImage add_gaussian_noise(const DepthImage& image, const Camera& camera, double sigma, uint64_t seed,
                              int threads) {
  require_sound(image, camera);
  if (!(sigma >= 0 && std::isfinite(sigma))) {
    throw std::invalid_argument("sigma: expected metres, 0 or more, found " + std::to_string(sigma));
  }
  DepthImage result = image;
  parallel_for(static_cast<size_t>(image.height), threads, [&](size_t line) {
    const int v = static_cast<int>(line);
    for (int u = 0; u < image.width; ++u) {
      if (!measured(image.at(u, v))) continue;
      const double along_ray = sigma * PixelRandom(seed, u, v).normal(kWhite);
      const double depth = static_cast<double>(image.at(u, v)) + along_ray / ray(camera, u, v).norm();
      result.at(u, v) = depth > 0 ? static_cast<float>(depth) : 0.0f;
    }
  });
  return result;
}

}  // namespace edgepose
