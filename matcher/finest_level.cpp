#include "matcher/finest_level.h"

#include <algorithm>
#include <array>

#include "matcher/normal_clusters.h"
#include "matcher/parallel.h"
#include "matcher/pixel_row.h"

namespace edgepose {
namespace {

constexpr size_t kStrips = 8;  // fixed, so that the result does not depend on the threads

/// Cells in groups that threads can merge at the same time.
constexpr size_t kCellGroups = 8;
size_t cell_group(uint64_t key) {
  return key * 0x9e3779b97f4a7c15ull >> 24 & (kCellGroups - 1);  // bits that choose no slot of a hash table
}

/// A point of one strip, and its cell.
struct StripPoint {
  uint64_t key;
  uint32_t number;  // in its strip
  WeightedPoint mean;
};

/// The points of one strip of the image.
struct Strip {
  std::array<std::vector<StripPoint>, kCellGroups> groups;  // each by rising number
  uint32_t count = 0;                                       // points in all of them
};

/// For the size of the hash table: enough for nearly all images, but small enough to stay in the cache.
size_t expected_clusters(size_t pixels) { return std::min<size_t>(pixels / 4, 8192); }

/// One strip in the making.
class StripSampler {
 public:
  StripSampler(const Scene::Data& scene, const Finest& how, int rows)
      : scene_(scene),
        how_(how),
        first_(how.stride / 2),
        row_(static_cast<size_t>(std::max(0, scene.width - first_ + how.stride - 1) / how.stride)),
        grid_(how.cell, how.theta_deg, expected_clusters(row_.key.size() * static_cast<size_t>(rows))) {
    for (size_t k = 0; k < row_.key.size(); ++k) row_.ray_x[k] = scene.ray(column(k), 0).x();
    for (int b = 0; b < NoiseCurve::kBins; ++b)
      usable_ |= (scene.noise.sigma[b] <= how.max_noise ? 1u : 0u) << b;
  }

  void add_row(int v) {
    const float* depth = scene_.smooth_depth.data() + scene_.index(0, v);
    const EdgeKind* edges = scene_.edges.data() + scene_.index(0, v);
    const Eigen::Vector3f* normals = scene_.normals.data() + scene_.index(0, v);
    read_pixels(row_, depth, edges, normals, first_, how_.stride);
    place_points(row_, {scene_.ray(0, v).y(), static_cast<float>(scene_.camera.fx),
                        static_cast<float>(how_.stride), how_.max_pixel_size, grid_.inverse_cell(), usable_});
    number_cells();
    grid_.add(row_.points());
  }

  Strip take() const {
    Strip strip;
    for (auto& group : strip.groups) group.reserve(grid_.size() / kCellGroups * 5 / 4);
    for (size_t i = 0; i < grid_.size(); ++i) {
      const WeightedPoint mean = grid_[i].mean();
      const uint64_t key = cell_key(mean.point.surface.position, grid_.inverse_cell());
      strip.groups[cell_group(key)].push_back({key, strip.count++, mean});
    }
    return strip;
  }

 private:
  /// Looks up each run of pixels in one cell once. Without branches on where the next run begins, which
  /// nobody can foresee.
  void number_cells() {
    size_t run = 0;
    uint64_t last = NormalClusterGrid::kNoKey;
    for (size_t k = 0; k < row_.key.size(); ++k) {
      const uint64_t key = row_.key[k];
      run += key != last ? 1 : 0;
      row_.run[k] = static_cast<uint32_t>(run);
      row_.run_key[run] = last = key;
    }
    row_.run_cell[0] = 0;
    for (size_t r = 1; r <= run; ++r)
      row_.run_cell[r] = row_.run_key[r] == NormalClusterGrid::kNoKey ? 0 : grid_.cell_of(row_.run_key[r]);
    for (size_t k = 0; k < row_.key.size(); ++k) row_.cell[k] = row_.run_cell[row_.run[k]];
  }

  int column(size_t k) const { return first_ + static_cast<int>(k) * how_.stride; }

  const Scene::Data& scene_;
  const Finest& how_;
  int first_;  // column
  PixelRow row_;
  NormalClusterGrid grid_;
  uint32_t usable_ = 0;  // bins of the noise curve
};

std::vector<Strip> sample_strips(const Scene::Data& scene, const Finest& how, int threads) {
  const int stride = how.stride;
  const int rows = (scene.height - stride / 2 + stride - 1) / stride;
  const auto row = [&](size_t strip) {
    return stride / 2 + stride * static_cast<int>(static_cast<size_t>(rows) * strip / kStrips);
  };
  std::vector<Strip> strips(kStrips);
  parallel_for(kStrips, threads, [&](size_t s) {
    const int first = row(s), last = std::min(row(s + 1), scene.height);
    StripSampler sampler(scene, how, (last - first + stride - 1) / stride);
    for (int v = first; v < last; v += stride) sampler.add_row(v);
    strips[s] = sampler.take();
  });
  return strips;
}

/// Merges what strips have in common. Threads share the cells; the points are in the order in which one
/// thread would begin them.
std::vector<WeightedPoint> merge_strips(const std::vector<Strip>& strips, const Finest& how, int threads) {
  uint32_t count = 0;
  for (const Strip& strip : strips) count += strip.count;
  std::array<std::vector<WeightedPoint>, kCellGroups> groups;
  std::vector<const WeightedPoint*> begun(count, nullptr);  // by the number of the point that began it
  parallel_for(kCellGroups, threads, [&](size_t g) {
    NormalClusterGrid grid(how.cell, how.theta_deg, count / kCellGroups);
    uint32_t before = 0;
    for (const Strip& strip : strips) {
      for (const StripPoint& p : strip.groups[g])
        grid.add(grid.cell_of(p.key), before + p.number, p.mean.point, p.mean.weight);
      before += strip.count;
    }
    groups[g].resize(grid.size());
    for (size_t i = 0; i < grid.size(); ++i) {
      groups[g][i] = grid[i].mean();
      begun[grid[i].first] = &groups[g][i];
    }
  });
  std::vector<WeightedPoint> points;
  points.reserve(count);
  for (const WeightedPoint* point : begun)
    if (point) points.push_back(*point);
  return points;
}

}  // namespace

std::vector<WeightedPoint> finest_level(const Scene::Data& scene, const Finest& how, int threads) {
  return merge_strips(sample_strips(scene, how, threads), how, threads);
}

}  // namespace edgepose
