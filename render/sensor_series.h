#pragma once
#include <cstdint>
#include <vector>

#include "render/sensor_model.h"

namespace edgepose {

/// apply_sensor() for many images of one camera, several times faster: the noise of measurement is drawn
/// once, into a few pictures, and each image takes one of them from another place on. What an image looks
/// like is the same; its bits are others than apply_sensor()'s. Safe from any thread.
class SensorSeries {
 public:
  /// `seed`: of the stored noise. Throws std::invalid_argument if sensor, camera or size are unsound.
  SensorSeries(const SensorModel& sensor, const Camera& camera, int width, int height, uint64_t seed);

  /// The same ideal image and seed give the same bits. On the calling thread. Throws std::invalid_argument if
  /// the image has another size.
  DepthImage apply(const DepthImage& ideal, uint64_t seed) const;

 private:
  void spoil_row(const DepthImage& ideal, int v, const float* noise, size_t noise_column, float sign,
                 uint64_t seed, DepthImage& result) const;
  void find_steep(const DepthImage& ideal, int v, std::vector<uint8_t>& doubtful) const;

  const SensorModel sensor_;
  const Camera camera_;
  const size_t width_, height_;
  std::vector<std::vector<float>> noise_;  ///< pictures of unit variance
  std::vector<float> per_ray_;             ///< 1 / length of the pixel's ray with z = 1
};

}  // namespace edgepose
