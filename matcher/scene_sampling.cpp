#include "matcher/scene_sampling.h"

#include <algorithm>

#include "matcher/finest_level.h"
#include "matcher/normal_clusters.h"
#include "matcher/parallel.h"

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

/// The next level: what the strips have in common merges. Threads share the cells; the points are in the
/// order in which one thread would begin them.
std::vector<WeightedPoint> middle_level(const std::vector<FineStrip>& strips, float cell, float theta_deg,
                                        int threads) {
  uint32_t count = 0;
  for (const FineStrip& strip : strips) count += strip.count;
  std::array<std::vector<WeightedPoint>, kCellGroups> groups;
  std::vector<const WeightedPoint*> begun(count, nullptr);  // by the number of the fine point that began it
  parallel_for(kCellGroups, threads, [&](size_t g) {
    NormalClusterGrid grid(cell, theta_deg, count / kCellGroups / 2);
    uint32_t before = 0;
    for (const FineStrip& strip : strips) {
      for (const FinePoint& p : strip.groups[g])
        grid.add(grid.cell_of(p.next_key), before + p.number, p.mean.point, p.mean.weight);
      before += strip.count;
    }
    groups[g].resize(grid.size());
    for (size_t i = 0; i < grid.size(); ++i) {
      groups[g][i] = grid[i].mean();
      begun[grid[i].first] = &groups[g][i];
    }
  });
  std::vector<WeightedPoint> points;
  points.reserve(count / 2);
  for (const WeightedPoint* point : begun)
    if (point) points.push_back(*point);
  return points;
}

}  // namespace

std::vector<SampledPoint> sample_scene(const Scene::Data& scene, float step, float diameter,
                                       const SamplingOptions& options, int threads) {
  const Finest finest = {
      pixel_stride(scene, step),   step / 2, step, options.fine_theta_deg, options.max_pixel_size * diameter,
      options.max_noise * diameter};
  const float middle_theta = options.fine_theta_deg * options.theta_factor;
  const float coarse_theta = middle_theta * options.theta_factor;
  const auto middle = middle_level(finest_level(scene, finest, threads), step, middle_theta, threads);

  std::vector<SampledPoint> points;
  points.reserve(middle.size());
  if (!options.keep_edges || middle.size() <= static_cast<size_t>(options.enough_points)) {
    for (const auto& [point, weight] : middle) points.push_back(point);
    return points;
  }
  NormalClusterGrid coarse(2 * step, coarse_theta, middle.size() / 2);
  for (const auto& [point, weight] : middle) {
    if (point.edge)
      points.push_back(point);
    else
      coarse.add(point, weight);
  }
  for (size_t i = 0; i < coarse.size(); ++i) points.push_back(coarse[i].mean().point);
  return points;
}

}  // namespace edgepose
