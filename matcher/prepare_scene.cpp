#include <chrono>
#include <cmath>
#include <stdexcept>

#include "matcher/edges.h"
#include "matcher/normals.h"
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
  scene->depth = image.depth;
  size_t measured = 0;
  for (float& z : scene->depth) {
    if (!(z >= options.min_depth && z <= options.max_depth)) z = 0;  // NaN too
    measured += z > 0;
  }
  if (measured == 0)
    throw std::invalid_argument(
        "depth image: expected measurements between min_depth and max_depth, found none");

  estimate_normals(*scene, options.threads);
  detect_edges(*scene, options.threads);
  scene->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return Scene(std::move(scene));
}

}  // namespace edgepose
