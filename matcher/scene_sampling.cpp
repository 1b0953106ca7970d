#include "matcher/scene_sampling.h"

#include <algorithm>
#include <iterator>

#include "matcher/finest_level.h"
#include "matcher/normal_clusters.h"
#include "matcher/scene_samples.h"

namespace edgepose {
namespace {

/// Pixels between two that are looked at: less than each where they are much denser than the finest grid.
int pixel_stride(const Scene::Data& scene, float step) {
  std::vector<float> depths;
  for (size_t i = 0; i < scene.smooth_depth.size(); i += 101)
    if (scene.smooth_depth[i] > 0) depths.push_back(scene.smooth_depth[i]);
  if (depths.empty()) return 1;
  const auto quarter = depths.begin() + static_cast<long>(depths.size() / 4);
  std::nth_element(depths.begin(), quarter, depths.end());
  return std::clamp(static_cast<int>(step / 4 / scene.pixel_size(*quarter)), 1, 8);
}

SceneSamples sample_for(const Scene::Data& scene, const SampleScale& scale, int threads) {
  const SamplingOptions& options = scale.options;
  const float step = scale.step_size(), diameter = scale.most_diameter();
  const Finest finest = {pixel_stride(scene, step), step, options.fine_theta_deg,
                         options.max_pixel_size * diameter, options.max_noise * diameter};
  const auto points = finest_level(scene, finest, threads);

  SceneSamples samples;
  samples.fine.reserve(points.size());
  for (const auto& [point, weight] : points) samples.fine.push_back(point);
  if (!options.keep_edges || points.size() <= static_cast<size_t>(options.enough_points)) return samples;
  samples.thinned.reserve(points.size() / 2);
  NormalClusterGrid coarse(2 * step, options.fine_theta_deg * options.theta_factor, points.size() / 2);
  for (const auto& [point, weight] : points) {
    if (point.edge)
      samples.thinned.push_back(point);
    else
      coarse.add(point, weight);
  }
  for (size_t i = 0; i < coarse.size(); ++i) samples.thinned.push_back(coarse[i].mean().point);
  samples.thinned.shrink_to_fit();  // they stay as long as the scene
  return samples;
}

}  // namespace

std::vector<SampledPoint> sample_scene(const Scene::Data& scene, float step, float diameter,
                                       const SamplingOptions& options, int threads) {
  const SampleScale scale(step, diameter, options);
  const SceneSamples& samples = scene.samples.get(scale, [&] { return sample_for(scene, scale, threads); });

  const auto usable = [&](const SampledPoint& p) {
    const float z = p.surface.position.z();
    return scene.pixel_size(z) <= options.max_pixel_size * diameter &&
           scene.noise.at(z) <= options.max_noise * diameter;
  };
  const auto& fine = samples.fine;
  const auto count = static_cast<size_t>(std::count_if(fine.begin(), fine.end(), usable));
  const bool thin = options.keep_edges && count > static_cast<size_t>(options.enough_points);
  std::vector<SampledPoint> points;
  points.reserve(thin ? samples.thinned.size() : count);
  std::copy_if(thin ? samples.thinned.begin() : fine.begin(), thin ? samples.thinned.end() : fine.end(),
               std::back_inserter(points), usable);
  return points;
}

}  // namespace edgepose
