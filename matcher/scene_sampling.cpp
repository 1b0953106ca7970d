#include "matcher/scene_sampling.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>

#include "matcher/parallel.h"
#include "matcher/point_grid.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr size_t kStrips = 8;       // of the image; fixed, so that the result does not depend on the threads
constexpr float kAreaUnit = 1e-4f;  // [d^2]
constexpr float kMaxPatchArea = 1e5f;  // [kAreaUnit d^2] keeps the sum of thousands in range

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
    const uint64_t key = cell_key(p.surface.position, inverse_cell_);
    // Neighbouring pixels mostly share a cluster.
    if (key != last_key_ || !faces_like(clusters_[last_], p)) last_ = cluster_of(key, p);
    last_key_ = key;
    Cluster& c = clusters_[last_];
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

  bool faces_like(const Cluster& c, const SampledPoint& p) const {
    const float along = c.normal.dot(p.surface.normal);
    return along > 0 && along * along >= cosine_ * cosine_ * c.normal.squaredNorm();
  }
  /// The cluster of a cell that a point belongs to; a new one if there is none.
  uint32_t cluster_of(uint64_t key, const SampledPoint& p) {
    uint32_t& head = heads_[slot_of(key)];
    uint32_t at = head;
    while (at != 0 && !faces_like(clusters_[at], p)) at = clusters_[at].next;
    if (at != 0) return at;
    at = static_cast<uint32_t>(clusters_.size());
    clusters_.push_back({});
    clusters_[at].next = head;
    return head = at;
  }
  size_t slot_of(uint64_t key) {
    if (used_ * 2 > keys_.size()) grow();
    // The product's highest bits are the ones that all of the key takes part in.
    size_t slot = key * 0x9e3779b97f4a7c15ull >> (64 - std::bit_width(keys_.size() - 1));
    while (keys_[slot] != key && keys_[slot] != kNoKey) slot = (slot + 1) & (keys_.size() - 1);
    if (keys_[slot] == kNoKey) keys_[slot] = key, ++used_;
    return slot;
  }
  void grow() {
    const std::vector<uint64_t> keys = std::move(keys_);
    const std::vector<uint32_t> heads = std::move(heads_);
    keys_.assign(keys.size() * 2, kNoKey);
    heads_.assign(keys.size() * 2, 0);
    used_ = 0;
    for (size_t i = 0; i < keys.size(); ++i)
      if (keys[i] != kNoKey) heads_[slot_of(keys[i])] = heads[i];
  }

  float inverse_cell_, cosine_;
  std::vector<Cluster> clusters_;
  std::vector<uint64_t> keys_;
  std::vector<uint32_t> heads_;
  size_t used_ = 0;
  uint64_t last_key_ = kNoKey;  // of the point added last,
  uint32_t last_ = 0;           // and its cluster
};

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

/// What the finest level is made of.
struct Finest {
  int stride;                       // pixels
  float cell;                       // [m]
  float theta_deg;                  // [degrees]
  float max_pixel_size, max_noise;  // [m]
};

/// The finest level: the pixels with a normal in some rows.
std::vector<std::pair<SampledPoint, float>> finest_level(const Scene::Data& scene, const Finest& how,
                                                         int first_row, int last_row) {
  NormalClusterGrid grid(how.cell, how.theta_deg, 2048);
  std::array<bool, NoiseCurve::kBins> usable;
  for (size_t b = 0; b < usable.size(); ++b) usable[b] = scene.noise.sigma[b] <= how.max_noise;
  const int first = how.stride / 2;
  std::vector<float> ray_x;
  for (int u = first; u < scene.width; u += how.stride) ray_x.push_back(scene.ray(u, 0).x());
  for (int v = first_row; v < last_row; v += how.stride) {
    const float ray_y = scene.ray(0, v).y();
    for (int u = first, k = 0; u < scene.width; u += how.stride, ++k) {
      const size_t at = scene.index(u, v);
      const float z = scene.smooth_depth[at];
      if (z <= 0 || scene.pixel_size(z) > how.max_pixel_size || !usable[NoiseCurve::bin(z)]) continue;
      const Eigen::Vector3f ray(ray_x[k], ray_y, 1.f);
      const Eigen::Vector3f& normal = scene.normals[at];
      const float slant = std::max(0.1f, -normal.dot(ray) / ray.norm());
      const float side = scene.pixel_size(z) * static_cast<float>(how.stride);
      grid.add({{z * ray, normal}, side * side / slant, scene.edges[at] != EdgeKind::kNone}, 1);
    }
  }
  return grid.take();
}

/// The finest level of the whole image, in strips that threads share; what strips have in common merges in
/// the next level.
std::vector<std::pair<SampledPoint, float>> finest_level(const Scene::Data& scene, const Finest& how,
                                                         int threads) {
  const int stride = how.stride;
  const int rows = (scene.height - stride / 2 + stride - 1) / stride;
  std::vector<std::vector<std::pair<SampledPoint, float>>> strips(kStrips);
  parallel_for(kStrips, threads, [&](size_t s) {
    const auto row = [&](size_t strip) {
      return stride / 2 + stride * static_cast<int>(static_cast<size_t>(rows) * strip / kStrips);
    };
    strips[s] = finest_level(scene, how, row(s), std::min(row(s + 1), scene.height));
  });
  std::vector<std::pair<SampledPoint, float>> points;
  for (const auto& strip : strips) points.insert(points.end(), strip.begin(), strip.end());
  return points;
}

/// Plane patches around a place, as structure of arrays. The area is a whole number, so that adding up in any
/// order gives the same.
struct Patches {
  std::vector<float> x, y, z, nx, ny, nz;
  std::vector<int32_t> area;  // [kAreaUnit d^2]

  void add(const SampledPoint& p, float area_units) {
    x.push_back(p.surface.position.x()), y.push_back(p.surface.position.y()),
        z.push_back(p.surface.position.z());
    nx.push_back(p.surface.normal.x()), ny.push_back(p.surface.normal.y()),
        nz.push_back(p.surface.normal.z());
    area.push_back(static_cast<int32_t>(area_units));
  }
};

/// Where the plane of a point is looked for.
struct PlaneQuery {
  float x, y, z, nx, ny, nz;  // the point and its normal
  float tolerance;            // [m] from the plane
  float reach;                // [m] from the point
  float cosine;               // of the angle between the normals, at least
};

/// Adds up the area of the patches that continue the plane.
EDGEPOSE_WIDE_SIMD int32_t area_on_plane(const Patches& patches, PlaneQuery q) {
  const float *x = patches.x.data(), *y = patches.y.data(), *z = patches.z.data(), *nx = patches.nx.data(),
              *ny = patches.ny.data(), *nz = patches.nz.data();
  const int32_t* areas = patches.area.data();
  const size_t count = patches.area.size();
  int32_t area = 0;
  for (size_t k = 0; k < count; ++k) {
    const float dx = x[k] - q.x, dy = y[k] - q.y, dz = z[k] - q.z;
    int32_t counted = std::abs(dx * q.nx + dy * q.ny + dz * q.nz) < q.tolerance ? areas[k] : 0;
    counted = dx * dx + dy * dy + dz * dz < q.reach * q.reach ? counted : 0;
    counted = nx[k] * q.nx + ny[k] * q.ny + nz[k] * q.nz > q.cosine ? counted : 0;
    area += counted;
  }
  return area;
}

}  // namespace

std::vector<SampledPoint> sample_scene(const Scene::Data& scene, float step, float diameter,
                                       const SamplingOptions& options, int threads) {
  const Finest finest = {pixel_stride(scene, step), step / 2, options.fine_theta_deg,
                         options.max_pixel_size * diameter, options.max_noise * diameter};
  const auto fine = finest_level(scene, finest, threads);
  const float middle_theta = options.fine_theta_deg * options.theta_factor;
  const float coarse_theta = middle_theta * options.theta_factor;

  std::vector<SampledPoint> points;
  NormalClusterGrid middle(step, middle_theta, fine.size());
  for (const auto& [point, weight] : fine) middle.add(point, weight);
  const auto middle_points = middle.take();
  if (!options.keep_edges || middle_points.size() <= static_cast<size_t>(options.enough_points)) {
    for (const auto& [point, weight] : middle_points) points.push_back(point);
    return points;
  }
  NormalClusterGrid coarse(2 * step, coarse_theta, fine.size() / 4);
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
  const float area_unit = kAreaUnit * diameter * diameter;
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
    Patches near;
    patch_grid.visit_near(points[jobs[job]->front()].surface.position, [&](uint32_t k) {
      near.add(patches[k], std::min(patches[k].area / area_unit, kMaxPatchArea));
      return true;
    });
    for (uint32_t i : *jobs[job]) {
      const Eigen::Vector3f &p = points[i].surface.position, &n = points[i].surface.normal;
      const float tolerance = 0.02f * diameter + 2 * noise.at(p.z());
      const int32_t area =
          area_on_plane(near, {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), tolerance, reach, kCosine});
      background[i] = static_cast<float>(area) * kAreaUnit > kMaxObjectArea;
    }
  });
  std::vector<SampledPoint> kept;
  for (size_t i = 0; i < points.size(); ++i)
    if (!background[i]) kept.push_back(points[i]);
  return kept;
}

}  // namespace edgepose
