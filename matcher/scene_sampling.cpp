#include "matcher/scene_sampling.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "matcher/parallel.h"
#include "matcher/point_grid.h"

namespace edgepose {
namespace {

/// Points of one cell with like normals, summed up.
struct Cluster {
  Eigen::Vector3f position = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();  // weighted sums
  float weight = 0, area = 0, edge_weight = 0;
  uint32_t next = 0;  // in the same cell, 0 = none
};

/// Merges points that share a cell of the grid and whose normals differ by less than theta.
class NormalClusterGrid {
 public:
  NormalClusterGrid(float cell, float theta_deg, size_t expected)
      : inverse_cell_(1 / cell),
        cosine_(std::cos(theta_deg * std::numbers::pi_v<float> / 180)),
        clusters_(1) {
    size_t size = 1024;
    while (size < 2 * expected) size *= 2;
    keys_.assign(size, kNoKey);
    heads_.assign(size, 0);
  }

  void add(const SampledPoint& p, float weight) {
    uint32_t& head = find(cell_key(p.surface.position, inverse_cell_));
    uint32_t at = head;
    while (at != 0 && clusters_[at].normal.dot(p.surface.normal) < cosine_ * clusters_[at].normal.norm())
      at = clusters_[at].next;
    if (at == 0) {
      at = static_cast<uint32_t>(clusters_.size());
      clusters_.push_back({});
      clusters_[at].next = head;
      head = at;
    }
    Cluster& c = clusters_[at];
    c.position += weight * p.surface.position;
    c.normal += weight * p.surface.normal;
    c.weight += weight;
    c.area += p.area;
    c.edge_weight += p.edge ? weight : 0;
  }

  std::vector<std::pair<SampledPoint, float>> take() const {
    std::vector<std::pair<SampledPoint, float>> points;
    for (size_t i = 1; i < clusters_.size(); ++i) {
      const Cluster& c = clusters_[i];
      points.push_back(
          {{{c.position / c.weight, c.normal.normalized()}, c.area, c.edge_weight > 0.3f * c.weight},
           c.weight});
    }
    return points;
  }

 private:
  static constexpr uint64_t kNoKey = ~uint64_t{0};

  uint32_t& find(uint64_t key) {
    if (used_ * 2 > keys_.size()) grow();
    size_t slot = (key * 0x9e3779b97f4a7c15ull >> 20) & (keys_.size() - 1);
    while (keys_[slot] != key && keys_[slot] != kNoKey) slot = (slot + 1) & (keys_.size() - 1);
    if (keys_[slot] == kNoKey) keys_[slot] = key, ++used_;
    return heads_[slot];
  }
  void grow() {
    const std::vector<uint64_t> keys = std::move(keys_);
    const std::vector<uint32_t> heads = std::move(heads_);
    keys_.assign(keys.size() * 2, kNoKey);
    heads_.assign(keys.size() * 2, 0);
    used_ = 0;
    for (size_t i = 0; i < keys.size(); ++i)
      if (keys[i] != kNoKey) find(keys[i]) = heads[i];
  }

  float inverse_cell_, cosine_;
  std::vector<Cluster> clusters_;
  std::vector<uint64_t> keys_;
  std::vector<uint32_t> heads_;
  size_t used_ = 0;
};

/// The finest level: every pixel with a normal, thinned where the pixels are much denser than the grid.
NormalClusterGrid finest_level(const Scene::Data& scene, const SamplingOptions& options) {
  std::vector<float> depths;
  for (size_t i = 0; i < scene.smooth_depth.size(); i += 101)
    if (scene.smooth_depth[i] > 0) depths.push_back(scene.smooth_depth[i]);
  float near = 0.5f;
  if (!depths.empty()) {
    std::nth_element(depths.begin(), depths.begin() + static_cast<long>(depths.size() / 4), depths.end());
    near = depths[depths.size() / 4];
  }
  const int stride = std::clamp(static_cast<int>(options.step / 2 / scene.pixel_size(near) / 2), 1, 8);
  NormalClusterGrid grid(options.step / 2, options.fine_theta_deg, 16384);
  for (int v = stride / 2; v < scene.height; v += stride)
    for (int u = stride / 2; u < scene.width; u += stride) {
      const size_t at = scene.index(u, v);
      const float z = scene.smooth_depth[at];
      if (z <= 0 || scene.pixel_size(z) > options.max_pixel_size || scene.noise.at(z) > options.max_noise)
        continue;
      const Eigen::Vector3f ray = scene.ray(u, v), normal = scene.normals[at];
      const float slant = std::max(0.1f, -normal.dot(ray) / ray.norm());
      const float side = scene.pixel_size(z) * static_cast<float>(stride);
      grid.add({{z * ray, normal}, side * side / slant, scene.edges[at] != EdgeKind::kNone}, 1);
    }
  return grid;
}

}  // namespace

std::vector<SampledPoint> sample_scene(const Scene::Data& scene, const SamplingOptions& options) {
  const auto fine = finest_level(scene, options).take();
  const float middle_theta = options.fine_theta_deg * options.theta_factor;
  const float coarse_theta = middle_theta * options.theta_factor;

  std::vector<SampledPoint> points;
  NormalClusterGrid middle(options.step, middle_theta, fine.size());
  for (const auto& [point, weight] : fine) middle.add(point, weight);
  const auto middle_points = middle.take();
  if (!options.keep_edges || middle_points.size() <= options.enough_points) {
    for (const auto& [point, weight] : middle_points) points.push_back(point);
    return points;
  }
  NormalClusterGrid coarse(2 * options.step, coarse_theta, fine.size() / 4);
  for (const auto& [point, weight] : middle_points) {
    if (point.edge)
      points.push_back(point);
    else
      coarse.add(point, weight);
  }
  for (const auto& [point, weight] : coarse.take()) points.push_back(point);
  return points;
}

std::vector<SampledPoint> drop_large_planes(const std::vector<SampledPoint>& points, float diameter,
                                            const NoiseCurve& noise, int threads) {
  constexpr float kPatch = 0.25f;      // [d] the scene is summed up in patches of this size first
  constexpr float kReach = 1.25f;      // [d] how far around a point its plane is followed
  constexpr float kMaxObjectArea = 1;  // [d^2] a plane face of an object covers at most pi / 4
  constexpr float kCosine = 0.97f;     // 14 degrees
  NormalClusterGrid grid(kPatch * diameter, 10, points.size() / 4);
  for (const SampledPoint& p : points) grid.add(p, p.area);
  std::vector<SampledPoint> patches;
  const auto taken = grid.take();
  patches.reserve(taken.size());
  for (const auto& [patch, weight] : taken) patches.push_back(patch);

  // Points of one coarse cell share the patches that are near enough to matter.
  const float reach = kReach * diameter;
  std::map<uint64_t, std::vector<uint32_t>> cells;
  for (uint32_t i = 0; i < points.size(); ++i)
    cells[cell_key(points[i].surface.position, 1 / reach)].push_back(i);
  PointGrid patch_grid(reach);
  for (uint32_t k = 0; k < patches.size(); ++k) patch_grid.add(patches[k].surface.position, k);
  std::vector<const std::vector<uint32_t>*> jobs;
  jobs.reserve(cells.size());
  for (const auto& [key, members] : cells) jobs.push_back(&members);

  std::vector<char> background(points.size(), 0);
  parallel_for(jobs.size(), threads, [&](size_t job) {
    std::vector<SampledPoint> near;
    patch_grid.visit_near(points[jobs[job]->front()].surface.position, [&](uint32_t k) {
      near.push_back(patches[k]);
      return true;
    });
    for (uint32_t i : *jobs[job]) {
      const OrientedPoint& p = points[i].surface;
      const float tolerance = 0.02f * diameter + 2 * noise.at(p.position.z());
      float area = 0;
      for (const SampledPoint& patch : near) {
        const Eigen::Vector3f d = patch.surface.position - p.position;
        if (std::abs(d.dot(p.normal)) < tolerance && d.squaredNorm() < reach * reach &&
            patch.surface.normal.dot(p.normal) > kCosine)
          area += patch.area;
      }
      background[i] = area > kMaxObjectArea * diameter * diameter;
    }
  });
  std::vector<SampledPoint> kept;
  for (size_t i = 0; i < points.size(); ++i)
    if (!background[i]) kept.push_back(points[i]);
  return kept;
}

}  // namespace edgepose
