#include "render/sensor_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/error.h"
#include "render/depth_renderer.h"
#include "tests/render/shapes.h"

namespace edgepose {
namespace {

using testing::HasSubstr;

const Camera kCamera{504, 504, 159.5, 119.5};
constexpr int kWidth = 320, kHeight = 240;

DepthImage wall(double depth, double turn_deg = 0) {
  RigidTransform pose = shapes::at(0, 0, depth);
  pose.rotate(Eigen::AngleAxisd(turn_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitY()));
  DepthRenderer renderer;
  renderer.add(shapes::rectangle(20, 20), pose);
  return renderer.render(kCamera, kWidth, kHeight).depth;
}

/// A square card in front of a wall.
DepthImage step(double near, double far) {
  DepthRenderer renderer;
  renderer.add(shapes::rectangle(20, 20), shapes::at(0, 0, far));
  renderer.add(shapes::rectangle(0.05f, 0.05f), shapes::at(0, 0, near));
  return renderer.render(kCamera, kWidth, kHeight).depth;
}

struct Statistics {
  double mean = 0, sigma = 0, neighbour_correlation = 0;
  int count = 0;
};

/// Of the error along the viewing ray (as_depth: along the optical axis).
Statistics error_statistics(const DepthImage& image, const DepthImage& truth, bool as_depth = false) {
  Statistics result;
  std::vector<double> errors(image.depth.size(), std::nan(""));
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if (image.at(u, v) <= 0) continue;
      const double x = (u - kCamera.cx) / kCamera.fx, y = (v - kCamera.cy) / kCamera.fy;
      double error = static_cast<double>(image.at(u, v) - truth.at(u, v));
      if (!as_depth) error *= std::sqrt(x * x + y * y + 1);
      errors[static_cast<size_t>(v * image.width + u)] = error;
      result.mean += error;
      ++result.count;
    }
  }
  result.mean /= result.count;
  double products = 0;
  int pairs = 0;
  for (size_t i = 0; i < errors.size(); ++i) {
    if (std::isnan(errors[i])) continue;
    result.sigma += (errors[i] - result.mean) * (errors[i] - result.mean);
    if (i + 1 < errors.size() && !std::isnan(errors[i + 1])) {
      products += (errors[i] - result.mean) * (errors[i + 1] - result.mean);
      ++pairs;
    }
  }
  result.sigma = std::sqrt(result.sigma / result.count);
  result.neighbour_correlation = products / pairs / (result.sigma * result.sigma);
  return result;
}

void expect_multiples_of(const DepthImage& image, double step) {
  for (const float depth : image.depth) {
    const double steps = static_cast<double>(depth) / step;
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
  }
}

size_t holes(const DepthImage& image) {
  return static_cast<size_t>(std::count(image.depth.begin(), image.depth.end(), 0.0f));
}

TEST(SensorModel, IdealChangesNothing) {
  const DepthImage truth = step(0.5, 0.7);
  EXPECT_EQ(apply_sensor(truth, kCamera, SensorModel::ideal(), 1).depth, truth.depth);
}

TEST(SensorModel, LaserHasItsSigmaAndSteps) {
  const DepthImage truth = wall(0.8);
  const DepthImage image = apply_sensor(truth, kCamera, SensorModel::laser(), 3);
  const Statistics error = error_statistics(image, truth);
  EXPECT_EQ(error.count, kWidth * kHeight);
  EXPECT_NEAR(error.mean, 0, 5e-6);
  // Quantisation adds step^2 / 12 to the variance.
  EXPECT_NEAR(error.sigma, std::sqrt(0.25e-3 * 0.25e-3 + 0.1e-3 * 0.1e-3 / 12), 5e-6);
  EXPECT_NEAR(error.neighbour_correlation, 0, 0.02);
  expect_multiples_of(image, 0.1e-3);
}

TEST(SensorModel, TimeOfFlightNoiseGrowsWithDepthAndIsCorrelated) {
  for (const double depth : {0.4, 0.7, 1.5}) {
    const DepthImage truth = wall(depth);
    const DepthImage image = apply_sensor(truth, kCamera, SensorModel::time_of_flight(), 3);
    const Statistics error = error_statistics(image, truth);
    const double sigma = 0.7e-3 + 0.6e-3 * depth * depth;
    EXPECT_NEAR(error.mean, 0, 0.04 * sigma) << depth;
    EXPECT_NEAR(error.sigma, std::sqrt(sigma * sigma + 1e-6 / 12), 0.05 * sigma) << depth;
    EXPECT_GT(error.neighbour_correlation, 0.4) << depth;
    EXPECT_NEAR(static_cast<double>(holes(image)) / (kWidth * kHeight), 0.001, 0.0006) << depth;
    expect_multiples_of(image, 1e-3);
  }
}

TEST(SensorModel, StructuredLightErrorGrowsWithTheSquareOfTheDepth) {
  const SensorModel sensor = SensorModel::structured_light();
  for (const double depth : {0.5, 1.0, 2.0}) {
    // Slightly turned: a plane of one disparity would round to few values. Depth changes by 6 % at most.
    const DepthImage truth = wall(depth, 10);
    const DepthImage image = apply_sensor(truth, kCamera, sensor, 3);
    const double pixels = std::hypot(sensor.disparity_noise, sensor.disparity_step / std::sqrt(12.0));
    const double sigma = depth * depth / (kCamera.fx * sensor.baseline) * pixels;
    EXPECT_NEAR(error_statistics(image, truth, true).sigma, sigma, 0.1 * sigma) << depth;
    for (const float z : image.depth) {
      if (z == 0) continue;
      const double steps = kCamera.fx * sensor.baseline / static_cast<double>(z) / sensor.disparity_step;
      ASSERT_NEAR(steps, std::round(steps), 1e-3);
    }
  }
}

TEST(SensorModel, StructuredLightLeavesTheProjectorsShadowLeftOfACard) {
  const DepthImage truth = step(0.5, 0.7);
  SensorModel sensor;  // nothing but the projector
  sensor.baseline = 0.075;
  const DepthImage image = apply_sensor(truth, kCamera, sensor, 3);
  // The card spans u = 159.5 +- 50.4; its shadow is as wide as the disparities differ.
  const double border = 110 - 504 * 0.075 * (1 / 0.5 - 1 / 0.7);
  for (int u = 0; u < kWidth; ++u) {
    EXPECT_GT(image.at(u, 20), 0) << "no shadow above the card";
    if (std::abs(u - border) <= 1) continue;
    EXPECT_EQ(image.at(u, 120) == 0, u < 110 && u > border) << u;
  }
}

TEST(SensorModel, SteepSurfacesAreNotSeen) {
  const auto share = [](double turn_deg, const SensorModel& sensor) {
    return static_cast<double>(holes(apply_sensor(wall(0.8, turn_deg), kCamera, sensor, 5))) /
           (kWidth * kHeight);
  };
  SensorModel sensor;
  sensor.fading_angle_deg = 25;
  sensor.blind_angle_deg = 65;
  EXPECT_EQ(share(0, sensor), 0);
  EXPECT_NEAR(share(45, sensor), 0.5, 0.05);
  sensor.blind_angle_deg = 40;
  EXPECT_EQ(share(65, sensor), 1);
}

TEST(SensorModel, FlyingPixelsHangBetweenTheTwoSidesOfAJump) {
  const DepthImage truth = step(0.5, 0.7);
  SensorModel sensor;
  sensor.flying_pixels = 0.5;
  const DepthImage image = apply_sensor(truth, kCamera, sensor, 5);
  int flying = 0;
  for (size_t i = 0; i < image.depth.size(); ++i) {
    if (image.depth[i] == truth.depth[i]) continue;
    EXPECT_GE(image.depth[i], 0.5f);
    EXPECT_LE(image.depth[i], 0.7f);
    ++flying;
  }
  // Half of the two rings of pixels along the card's border, about 100 pixels a side.
  EXPECT_NEAR(flying, 0.5 * 2 * 4 * 101, 80);
}

TEST(SensorModel, SameSeedSameBitsAtAnyThreadCount) {
  const DepthImage truth = step(0.5, 0.7);
  for (const char* name : {"ideal", "laser", "structured_light", "time_of_flight"}) {
    const SensorModel sensor = SensorModel::named(name);
    const DepthImage one = apply_sensor(truth, kCamera, sensor, 42, 1);
    for (const int threads : {2, 5}) {
      EXPECT_EQ(one.depth, apply_sensor(truth, kCamera, sensor, 42, threads).depth) << name;
    }
    if (std::string(name) != "ideal") {
      EXPECT_NE(one.depth, apply_sensor(truth, kCamera, sensor, 43, 1).depth) << name;
    }
  }
}

TEST(SensorModel, RangeIsKept) {
  const size_t all = kWidth * kHeight;
  EXPECT_EQ(holes(apply_sensor(wall(0.2), kCamera, SensorModel::time_of_flight(), 1)), all);
  EXPECT_EQ(holes(apply_sensor(wall(7), kCamera, SensorModel::time_of_flight(), 1)), all);
}

TEST(SensorModel, CheckNamesTheBadField) {
  EXPECT_EQ(SensorModel::laser().check(), "");
  EXPECT_EQ(SensorModel::structured_light().check(), "");
  EXPECT_EQ(SensorModel::time_of_flight().check(), "");
  SensorModel sensor;
  sensor.flying_pixels = 1.5;
  EXPECT_THAT(sensor.check(), HasSubstr("flying_pixels"));
  EXPECT_THROW(apply_sensor(wall(1), kCamera, sensor, 1), std::invalid_argument);
  sensor = {};
  sensor.noise = std::nan("");
  EXPECT_THAT(sensor.check(), HasSubstr("noise"));
  sensor = {};
  sensor.disparity_step = 0.1;
  EXPECT_THAT(sensor.check(), HasSubstr("baseline"));
  EXPECT_THROW(SensorModel::named("sonar"), InputError);
}

TEST(SensorModel, RefusesUnsoundInput) {
  DepthImage image = wall(1);
  EXPECT_THROW(apply_sensor(image, {0, 1, 0, 0}, {}, 1), std::invalid_argument);
  EXPECT_THROW(add_gaussian_noise(image, kCamera, -1, 1), std::invalid_argument);
  image.depth.pop_back();
  EXPECT_THROW(apply_sensor(image, kCamera, {}, 1), std::invalid_argument);
  EXPECT_THROW(add_gaussian_noise(image, kCamera, 1e-3, 1), std::invalid_argument);
}

TEST(GaussianNoise, MovesPointsAlongTheRayByItsSigma) {
  const DepthImage truth = wall(0.8, 30);
  for (const double sigma : {0.0005, 0.001, 0.002}) {
    const Statistics error = error_statistics(add_gaussian_noise(truth, kCamera, sigma, 9), truth);
    EXPECT_NEAR(error.mean, 0, 0.02 * sigma);
    EXPECT_NEAR(error.sigma, sigma, 0.02 * sigma);
    EXPECT_NEAR(error.neighbour_correlation, 0, 0.02);
  }
  EXPECT_EQ(add_gaussian_noise(truth, kCamera, 0, 9).depth, truth.depth);
  EXPECT_EQ(add_gaussian_noise(truth, kCamera, 1e-3, 9, 1).depth,
            add_gaussian_noise(truth, kCamera, 1e-3, 9, 4).depth);
  EXPECT_NE(add_gaussian_noise(truth, kCamera, 1e-3, 9).depth,
            add_gaussian_noise(truth, kCamera, 1e-3, 10).depth);
}

TEST(GaussianNoise, KeepsHoles) {
  DepthImage image = wall(0.8);
  image.at(7, 9) = 0;
  EXPECT_EQ(add_gaussian_noise(image, kCamera, 1e-3, 1).at(7, 9), 0);
}

}  // namespace
}  // namespace edgepose
