#include "render/sensor_series.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "render/sensor_pixel.h"

namespace edgepose {
namespace {

using namespace internal;

constexpr uint64_t kPictures = 8;

/// Pixels up to the next that drops out, if each does so with `chance`.
size_t gap(double chance, double uniform) {
  if (chance <= 0) return SIZE_MAX / 2;
  if (chance >= 1) return 0;
  return static_cast<size_t>(std::log(uniform) / std::log1p(-chance));
}

}  // namespace

SensorSeries::SensorSeries(const SensorModel& sensor, const Camera& camera, int width, int height,
                           uint64_t seed)
    : sensor_(sensor),
      camera_(camera),
      width_(static_cast<size_t>(width)),
      height_(static_cast<size_t>(height)) {
  if (const std::string fault = sensor.check(); !fault.empty()) throw std::invalid_argument(fault);
  if (width < 3 || height < 3 || width > 4096 || height > 4096)
    throw std::invalid_argument("sensor series: expected sides of 3 to 4096 pixels");
  if (!(camera.fx > 0 && camera.fy > 0 && std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy)))
    throw std::invalid_argument("camera: expected finite numbers with positive fx and fy");
  const double white = std::sqrt(1 - sensor.correlated_share), shared = std::sqrt(sensor.correlated_share);
  for (uint64_t picture = 0; picture < kPictures; ++picture) {
    std::vector<float> noise = correlated_noise(width, height, sensor.correlation_radius, seed + picture, 1);
    for (size_t i = 0; i < noise.size(); ++i) {
      const PixelRandom random(seed + picture, static_cast<int>(i % width_), static_cast<int>(i / width_));
      noise[i] = static_cast<float>(shared * static_cast<double>(noise[i]) + white * random.normal(kWhite));
    }
    noise_.push_back(std::move(noise));
  }
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) per_ray_.push_back(static_cast<float>(1 / ray(camera, u, v).norm()));
}

DepthImage SensorSeries::apply(const DepthImage& ideal, uint64_t seed) const {
  if (static_cast<size_t>(ideal.width) != width_ || static_cast<size_t>(ideal.height) != height_ ||
      ideal.depth.size() != width_ * height_)
    throw std::invalid_argument("sensor series: an image of another size");
  // Shadows of a projector go along whole rows.
  if (sensor_.baseline > 0) return apply_sensor(ideal, camera_, sensor_, seed, 1);
  const PixelRandom place(seed, -1, -1);
  const auto drawn = [&](uint32_t stream, size_t count) {
    return static_cast<size_t>(place.uniform(stream) * static_cast<double>(count));
  };
  const std::vector<float>& noise = noise_[drawn(0, kPictures)];
  const size_t column = drawn(1, width_), row = drawn(2, height_);
  const float sign = place.uniform(3) < 0.5 ? -1.0f : 1.0f;
  DepthImage result{ideal.width, ideal.height, std::vector<float>(ideal.depth.size(), 0.0f)};
  for (size_t v = 0; v < height_; ++v)
    spoil_row(ideal, static_cast<int>(v), &noise[(v + row) % height_ * width_], column, sign, seed, result);

  size_t drop = 0;
  for (int i = 0;; ++i) {
    drop += gap(sensor_.dropout, PixelRandom(seed, i, -2).uniform(kDropout));
    if (drop >= result.depth.size()) return result;
    result.depth[drop++] = 0;
  }
}

/// Marks the pixels at which something other than noise may happen: at the border, beside what is not
/// measured, at depth jumps, on steep surfaces. All others see a smooth surface from before it.
void SensorSeries::find_steep(const DepthImage& ideal, int v, std::vector<uint8_t>& doubtful) const {
  doubtful.assign(width_, 1);
  if (v == 0 || v + 1 == ideal.height) return;
  const float* middle = &ideal.depth[static_cast<size_t>(v) * width_];
  const float *above = middle - width_, *below = middle + width_;
  // For the normal n = a x b of two neighbouring points' differences, n . ray is z_a z_b / (fx fy).
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto fading = static_cast<float>(std::cos(sensor_.fading_angle_deg * std::numbers::pi / 180));
  const float least_square = sensor_.fading_angle_deg >= 90 ? 0 : 1.1f * fading * fading;
  const auto jump = static_cast<float>(sensor_.jump_threshold);
  const auto y = static_cast<float>((v - camera_.cy) / camera_.fy);
  const auto cx = static_cast<float>(camera_.cx);
  const float* per_ray = &per_ray_[static_cast<size_t>(v) * width_];
  for (size_t u = 1; u + 1 < width_; ++u) {
    const float z = middle[u];
    float near = z, far = z;
    for (const float* line : {above, middle, below})
      for (size_t i = u - 1; i <= u + 1; ++i) near = std::min(near, line[i]), far = std::max(far, line[i]);
    const float left = z - middle[u - 1], right = middle[u + 1] - z;
    const float up = z - above[u], down = below[u] - z;
    const float du = std::min(std::abs(left), std::abs(right)), dv = std::min(std::abs(up), std::abs(down));
    // Normal of the surface with these slopes: (-dz/dx, -dz/dy, 1 + x dz/dx + y dz/dy) up to scale; the signs
    // that make the angle largest.
    const float sx = du * fx / z, sy = dv * fy / z;
    const float x = (static_cast<float>(u) - cx) / fx;
    const float third = 1 + std::abs(x) * sx + std::abs(y) * sy;
    const float square = sx * sx + sy * sy + third * third;
    const float cosine = per_ray[u];
    const bool smooth = near > 0 && far - near <= jump * near && cosine * cosine >= least_square * square;
    doubtful[u] = smooth ? 0 : 1;
  }
}

void SensorSeries::spoil_row(const DepthImage& ideal, int v, const float* noise, size_t noise_column,
                             float sign, uint64_t seed, DepthImage& result) const {
  std::vector<uint8_t> doubtful;
  find_steep(ideal, v, doubtful);
  SensorModel rest = sensor_;  // whole pixels drop out at the end
  rest.dropout = 0;
  const size_t first = static_cast<size_t>(v) * width_;
  const auto constant = static_cast<float>(sensor_.noise),
             square = static_cast<float>(sensor_.noise_per_square_metre);
  const auto step = static_cast<float>(sensor_.depth_step);
  const float steps = step > 0 ? 1 / step : 0;
  const auto least = static_cast<float>(sensor_.min_depth), most = static_cast<float>(sensor_.max_depth);
  std::vector<float> unit(width_);
  for (size_t u = 0; u < width_; ++u)
    unit[u] = sign * noise[u + noise_column < width_ ? u + noise_column : u + noise_column - width_];
  for (size_t u = 0; u < width_; ++u) {
    const float z = ideal.depth[first + u];
    float depth = z + (constant + square * z * z) * unit[u] * per_ray_[first + u];
    depth = step > 0 ? std::nearbyint(depth * steps) * step : depth;
    result.depth[first + u] = z > 0 && depth >= least && depth <= most ? depth : 0;
  }
  for (size_t u = 0; u < width_; ++u) {
    if (doubtful[u] == 0 || !measured(ideal.depth[first + u])) continue;
    const int column = static_cast<int>(u);
    const PixelRandom random(seed, column, v);
    double depth = ideal.depth[first + u];
    const auto [nearest, farthest] = depth_range_around(ideal, column, v);
    const bool at_jump = farthest - nearest > sensor_.jump_threshold * nearest;
    result.depth[first + u] = 0;
    if (!is_seen(ideal, camera_, rest, at_jump, random, column, v)) continue;
    if (at_jump && random.uniform(kFlying) < sensor_.flying_pixels)
      depth = nearest + random.uniform(kFlyingShare) * (farthest - nearest);
    depth = with_noise(depth, sensor_, camera_, 1 / static_cast<double>(per_ray_[first + u]),
                       static_cast<double>(unit[u]));
    if (depth > 0 && depth >= sensor_.min_depth && depth <= sensor_.max_depth)
      result.depth[first + u] = static_cast<float>(depth);
  }
}

}  // namespace edgepose
