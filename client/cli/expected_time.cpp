#include "client/cli/expected_time.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "matcher/model_block.h"

namespace edgepose {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr Camera kCamera{600, 600, 319.5, 239.5};

/// Paints one surface point as a small piece of its tangent plane, nearer pixels first.
void splat(DepthImage& image, const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float radius) {
  const auto fx = static_cast<float>(kCamera.fx), cx = static_cast<float>(kCamera.cx),
             cy = static_cast<float>(kCamera.cy);
  const int reach = static_cast<int>(std::ceil(fx * radius / point.z()));
  const int u0 = static_cast<int>(std::lround(fx * point.x() / point.z() + cx));
  const int v0 = static_cast<int>(std::lround(fx * point.y() / point.z() + cy));
  for (int v = std::max(0, v0 - reach); v <= std::min(kHeight - 1, v0 + reach); ++v) {
    for (int u = std::max(0, u0 - reach); u <= std::min(kWidth - 1, u0 + reach); ++u) {
      const Eigen::Vector3f ray((static_cast<float>(u) - cx) / fx, (static_cast<float>(v) - cy) / fx, 1.f);
      const float slope = normal.dot(ray);
      if (slope > -0.1f) continue;  // seen at a grazing angle: its plane says nothing about this pixel
      const float z = normal.dot(point) / slope;
      if (std::abs(z - point.z()) > radius) continue;
      image.at(u, v) = std::min(image.at(u, v), z);
    }
  }
}

DepthImage picture_of(const Model& model) {
  const Model::View& view = model.view();
  const auto diameter = static_cast<float>(model.diameter());
  // The object spans a third of the image's height.
  const float distance = diameter * static_cast<float>(kCamera.fx) * 3 / kHeight;
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(0.8f, Eigen::Vector3f(1.f, 0.5f, 0.2f).normalized()).toRotationMatrix();
  const Eigen::Vector3f centre = model.centre().cast<float>();
  DepthImage image{kWidth, kHeight, std::vector<float>(size_t{kWidth} * kHeight, distance + diameter)};
  for (const OrientedPoint& point : view.dense_points) {
    const Eigen::Vector3f position = turn * (point.position - centre) + Eigen::Vector3f(0, 0, distance);
    splat(image, position, turn * point.normal, static_cast<float>(view.header->dense_step));
  }
  return image;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

ExpectedTime measure_expected_time(const Model& model, int threads) {
  const DepthImage image = picture_of(model);
  SceneOptions scene_options;
  scene_options.min_depth = 0.001f;
  scene_options.max_depth = 1e3f;
  scene_options.threads = threads;
  MatchOptions match_options;
  match_options.threads = threads;
  std::array<ExpectedTime, 3> runs;
  for (ExpectedTime& run : runs) {
    const auto start = std::chrono::steady_clock::now();
    const Scene scene = prepare_scene(image, kCamera, scene_options);
    run.preprocessing = seconds_since(start);
    const auto middle = std::chrono::steady_clock::now();
    match(scene, model, match_options);
    run.matching = seconds_since(middle);
  }
  std::sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.total() < b.total(); });
  return runs[1];
}

}  // namespace edgepose
