#include "render/sensor_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace edgepose {
namespace {

constexpr Camera kSeriesCamera{250, 250, 159.5, 119.5};

/// A slanted wall with a box before it, and a part that cannot be measured.
DepthImage wall_and_box() {
  DepthImage image{320, 240, std::vector<float>(320 * 240)};
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      const bool box = u > 100 && u < 200 && v > 60 && v < 160;
      image.at(u, v) = u < 10 ? 0.0f : box ? 0.8f : 1.0f + 0.001f * static_cast<float>(u);
    }
  return image;
}

struct Spoilage {
  double mean = 0, sigma = 0,
         neighbours = 0;  ///< [m], [m], correlation of the error with the right neighbour's
  int holes = 0, flying = 0;
};
Spoilage spoiled_by(const DepthImage& ideal, const DepthImage& image) {
  Spoilage result;
  int count = 0;
  double products = 0;
  for (int v = 0; v < 240; ++v)
    for (int u = 10; u + 1 < 320; ++u) {
      if (image.at(u, v) == 0) ++result.holes;
      const double error = static_cast<double>(image.at(u, v) - ideal.at(u, v));
      const double next = static_cast<double>(image.at(u + 1, v) - ideal.at(u + 1, v));
      if (image.at(u, v) > 0 && std::abs(error) > 0.02) ++result.flying;
      if (std::abs(error) > 0.02 || std::abs(next) > 0.02) continue;
      ++count, result.mean += error, result.sigma += error * error, products += error * next;
    }
  result.mean /= count;
  result.neighbours = products / result.sigma;
  result.sigma = std::sqrt(result.sigma / count);
  return result;
}

TEST(SensorSeries, SpoilsAsApplySensorDoes) {
  const DepthImage ideal = wall_and_box();
  const SensorModel sensor = SensorModel::time_of_flight();
  const SensorSeries series(sensor, kSeriesCamera, 320, 240, 9);
  Spoilage a, b;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const auto add = [](Spoilage& sum, const Spoilage& one) {
      sum.mean += one.mean / 10, sum.sigma += one.sigma / 10, sum.neighbours += one.neighbours / 10;
      sum.holes += one.holes, sum.flying += one.flying;
    };
    add(a, spoiled_by(ideal, apply_sensor(ideal, kSeriesCamera, sensor, seed)));
    add(b, spoiled_by(ideal, series.apply(ideal, seed)));
  }
  EXPECT_NEAR(a.mean, b.mean, 3e-5);
  EXPECT_NEAR(a.sigma, b.sigma, 0.02 * a.sigma);
  EXPECT_NEAR(a.neighbours, b.neighbours, 0.02);
  EXPECT_GT(a.neighbours, 0.3);
  EXPECT_NEAR(a.holes, b.holes, 4 * std::sqrt(2.0 * a.holes));
  EXPECT_NEAR(a.flying, b.flying, 4 * std::sqrt(2.0 * a.flying));
  EXPECT_GT(a.flying, 100);
}

/// Where nothing is drawn, both give the same bits.
TEST(SensorSeries, WithoutNoiseTheSame) {
  const DepthImage ideal = wall_and_box();
  SensorModel sensor;
  sensor.min_depth = 0.9, sensor.max_depth = 1.2005;
  const SensorSeries series(sensor, kSeriesCamera, 320, 240, 1);
  EXPECT_EQ(series.apply(ideal, 5).depth, apply_sensor(ideal, kSeriesCamera, sensor, 5).depth);
}

TEST(SensorSeries, SurfacesThatAreTooSteepAreNotMeasured) {
  DepthImage ideal = wall_and_box();
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) ideal.at(u, v) = 1.0f + 0.019f * static_cast<float>(u);
  SensorModel sensor;
  sensor.fading_angle_deg = 60, sensor.blind_angle_deg = 60;
  const SensorSeries series(sensor, kSeriesCamera, 320, 240, 1);
  const DepthImage expected = apply_sensor(ideal, kSeriesCamera, sensor, 5);
  EXPECT_EQ(series.apply(ideal, 5).depth, expected.depth);
  EXPECT_NE(std::count(expected.depth.begin(), expected.depth.end(), 0.0f), 0);
  EXPECT_NE(std::count(expected.depth.begin(), expected.depth.end(), 0.0f), 320 * 240);
}

TEST(SensorSeries, SameSeedSameBitsAndOthersDiffer) {
  const DepthImage ideal = wall_and_box();
  const SensorSeries one(SensorModel::time_of_flight(), kSeriesCamera, 320, 240, 1), two = one;
  EXPECT_EQ(one.apply(ideal, 3).depth, two.apply(ideal, 3).depth);
  EXPECT_NE(one.apply(ideal, 3).depth, one.apply(ideal, 4).depth);
}

TEST(SensorSeries, RefusesWhatDoesNotFit) {
  const SensorSeries series(SensorModel::laser(), kSeriesCamera, 64, 64, 1);
  EXPECT_THROW(series.apply(wall_and_box(), 1), std::invalid_argument);
  EXPECT_THROW(SensorSeries(SensorModel::laser(), Camera{}, 64, 64, 1), std::invalid_argument);
  EXPECT_THROW(SensorSeries(SensorModel::laser(), kSeriesCamera, 2, 64, 1), std::invalid_argument);
  SensorModel wrong;
  wrong.noise = -1;
  EXPECT_THROW(SensorSeries(wrong, kSeriesCamera, 64, 64, 1), std::invalid_argument);
}

}  // namespace
}  // namespace edgepose
