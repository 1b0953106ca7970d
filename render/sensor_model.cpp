#include "render/sensor_model.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "matcher/parallel.h"
#include "render/pixel_random.h"
#include "render/sensor_pixel.h"

namespace edgepose {

std::vector<float> internal::correlated_noise(int width, int height, double radius, uint64_t seed,
                                              int threads) {
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

namespace {

using namespace internal;

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
