#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "matcher/edges.h"
#include "matcher/normals.h"
#include "matcher/parallel.h"
#include "matcher/scene_data.h"

namespace edgepose {
namespace {

void check_input(const DepthImage& image, const Camera& camera, const SceneOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw std::invalid_argument(fault);
  if (image.width < 16 || image.height < 16 || image.width > 16384 || image.height > 16384)
    throw std::invalid_argument("depth image: expected 16 to 16384 pixels a side, found " +
                                std::to_string(image.width) + " x " + std::to_string(image.height));
  if (image.depth.size() != static_cast<size_t>(image.width) * image.height)
    throw std::invalid_argument("depth image: expected width * height values, found " +
                                std::to_string(image.depth.size()));
  if (!(camera.fx > 0 && camera.fy > 0 && std::isfinite(camera.fx) && std::isfinite(camera.fy)) ||
      !std::isfinite(camera.cx) || !std::isfinite(camera.cy))
    throw std::invalid_argument("camera: expected positive fx, fy and finite cx, cy, found fx " +
                                std::to_string(camera.fx) + ", fy " + std::to_string(camera.fy));
}

/// Copies the depths that are in range and returns how many there are.
size_t take_depth(const DepthImage& image, const SceneOptions& options, Scene::Data& scene) {
  constexpr int kRowsPerDepthJob = 64;
  scene.depth = image.depth;
  std::vector<size_t> measured(static_cast<size_t>((image.height + kRowsPerDepthJob - 1) / kRowsPerDepthJob));
  parallel_for(measured.size(), options.threads, [&](size_t job) {
    const int first = static_cast<int>(job) * kRowsPerDepthJob,
              last = std::min(image.height, first + kRowsPerDepthJob);
    float* depth = scene.depth.data();
    size_t count = 0;
    for (size_t i = scene.index(0, first); i < scene.index(0, last); ++i) {
      const bool usable = depth[i] >= options.min_depth && depth[i] <= options.max_depth;  // not NaN
      depth[i] = usable ? depth[i] : 0.f;
      count += usable;
    }
    measured[job] = count;
  });
  return std::accumulate(measured.begin(), measured.end(), size_t{0});
}

}  // namespace

std::string SceneOptions::check() const {
  if (!(min_depth >= 0.001f && min_depth < max_depth && max_depth <= 1000))
    return "min_depth, max_depth: expected 0.001 <= min_depth < max_depth <= 1000 m";
  return "";
}

double Scene::preprocessing_seconds() const { return data_->seconds; }

Scene prepare_scene(const DepthImage& image, const Camera& camera, const SceneOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_input(image, camera, options);
  auto scene = std::make_shared<Scene::Data>();
  scene->width = image.width;
  scene->height = image.height;
  scene->camera = camera;
  const size_t measured = take_depth(image, options, *scene);
  if (measured == 0)
    throw std::invalid_argument(
        "depth image: expected measurements between min_depth and max_depth, found none");

  estimate_normals(*scene, options.threads);
  detect_edges(*scene, options.threads);
  scene->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return Scene(std::move(scene));
}

}  // namespace edgepose
