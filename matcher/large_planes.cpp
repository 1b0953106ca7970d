#include "matcher/large_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "matcher/normal_clusters.h"
#include "matcher/parallel.h"
#include "matcher/point_grid.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr float kAreaUnit = 1e-4f;     // [d^2]
constexpr float kMaxPatchArea = 1e5f;  // [kAreaUnit d^2] keeps the sum of thousands in range

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

/// Adds up the area of the patches that continue the plane, until there is more than `enough`.
EDGEPOSE_WIDE_SIMD int32_t area_on_plane(const Patches& patches, PlaneQuery q, int32_t enough) {
  constexpr size_t kAtOnce = 128;
  const float *x = patches.x.data(), *y = patches.y.data(), *z = patches.z.data(), *nx = patches.nx.data(),
              *ny = patches.ny.data(), *nz = patches.nz.data();
  const int32_t* areas = patches.area.data();
  const size_t count = patches.area.size();
  int32_t area = 0;
  for (size_t first = 0; first < count && area <= enough; first += kAtOnce) {
    const size_t last = std::min(count, first + kAtOnce);
    for (size_t k = first; k < last; ++k) {
      const float dx = x[k] - q.x, dy = y[k] - q.y, dz = z[k] - q.z;
      int32_t counted = std::abs(dx * q.nx + dy * q.ny + dz * q.nz) < q.tolerance ? areas[k] : 0;
      counted = dx * dx + dy * dy + dz * dz < q.reach * q.reach ? counted : 0;
      counted = nx[k] * q.nx + ny[k] * q.ny + nz[k] * q.nz > q.cosine ? counted : 0;
      area += counted;
    }
  }
  return area;
}

}  // namespace

std::vector<SampledPoint> drop_large_planes(const std::vector<SampledPoint>& points, float diameter,
                                            const NoiseCurve& noise, int threads) {
  constexpr float kPatch = 0.25f;      // [d] the scene is summed up in patches of this size first
  constexpr float kReach = 1.25f;      // [d] how far around a point its plane is followed
  constexpr int32_t kMaxArea = 10000;  // [kAreaUnit d^2] a plane face of an object covers at most pi / 4
  constexpr float kCosine = 0.97f;     // 14 degrees
  const float area_unit = kAreaUnit * diameter * diameter;
  NormalClusterGrid grid(kPatch * diameter, 10, points.size() / 4);
  for (const SampledPoint& p : points) grid.add(p, p.area);
  std::vector<SampledPoint> patches;
  patches.reserve(grid.size());
  for (size_t i = 0; i < grid.size(); ++i) patches.push_back(grid[i].mean().point);

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
    Eigen::AlignedBox3f box;
    for (uint32_t i : *jobs[job]) box.extend(points[i].surface.position);
    Patches near;
    int64_t total = 0;
    patch_grid.visit_near(points[jobs[job]->front()].surface.position, [&](uint32_t k) {
      if (box.exteriorDistance(patches[k].surface.position) > 1.001f * reach) return true;
      near.add(patches[k], std::min(patches[k].area / area_unit, kMaxPatchArea));
      total += near.area.back();
      return true;
    });
    if (total <= kMaxArea) return;
    for (uint32_t i : *jobs[job]) {
      const Eigen::Vector3f &p = points[i].surface.position, &n = points[i].surface.normal;
      const float tolerance = 0.02f * diameter + 2 * noise.at(p.z());
      const int32_t area = area_on_plane(
          near, {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), tolerance, reach, kCosine}, kMaxArea);
      background[i] = area > kMaxArea;
    }
  });
  std::vector<SampledPoint> kept;
  for (size_t i = 0; i < points.size(); ++i)
    if (!background[i]) kept.push_back(points[i]);
  return kept;
}

}  // namespace edgepose
