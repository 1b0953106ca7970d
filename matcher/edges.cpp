#include "matcher/edges.h"

#include <algorithm>
#include <array>

#include "matcher/parallel.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr float kJumpPixels = 4;        // a jump is at least this many pixel sizes deep ...
constexpr float kJumpNoise = 6;         // ... and this many times the noise
constexpr int kGap = 3;                 // pixels without measurement that a jump may hide in
constexpr int kCreaseReach = 4;         // pixels on either side of a crease
constexpr float kCreaseCosine = 0.87f;  // 30 degrees between the two sides
constexpr std::array<std::array<int, 2>, 4> kDirections = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

/// Depth at which the pixel's plane continues in the neighbouring pixel.
float continued_depth(const Scene::Data& scene, int u, int v, int nu, int nv) {
  const size_t at = scene.index(u, v);
  const Eigen::Vector3f& normal = scene.normals[at];
  const float slant = normal.dot(scene.ray(nu, nv));
  if (slant > -0.05f) return scene.depth[at];  // grazing: the continuation says nothing
  return normal.dot(scene.smooth_point(u, v)) / slant;
}

/// Marks the pixels of row v near which something could be an outline: a hole, or a step that is large
/// enough, in one of the four directions. Few pixels are left to look at closely.
EDGEPOSE_WIDE_SIMD void mark_steps(const float* centre, std::array<const float*, 2 * kGap> rows, int width,
                                   float jump_for_depth, uint8_t* marked) {
  for (int u = kGap; u < width - kGap; ++u) {
    float least = centre[u], most = centre[u];
#pragma GCC unroll 3
    for (int k = 1; k <= kGap; ++k) {
      least = std::min(least, std::min(centre[u - k], centre[u + k]));
      most = std::max(most, std::max(centre[u - k], centre[u + k]));
    }
#pragma GCC unroll 6
    for (const float* row : rows) {
      least = std::min(least, row[u]);
      most = std::max(most, row[u]);
    }
    marked[u] = least <= 0 || most > centre[u] + jump_for_depth * centre[u] ? 1 : 0;
  }
}

/// For each pixel of row v whether outline_kind() need look at it.
void mark_row(const Scene::Data& scene, int v, std::vector<uint8_t>& marked) {
  std::fill(marked.begin(), marked.end(), uint8_t{1});
  if (v < kGap || v >= scene.height - kGap) return;
  const float* centre = scene.depth.data() + scene.index(0, v);
  std::array<const float*, 2 * kGap> rows;
  for (int k = 0; k < kGap; ++k) {
    rows[2 * k] = centre - (k + 1) * scene.width;
    rows[2 * k + 1] = centre + (k + 1) * scene.width;
  }
  mark_steps(centre, rows, scene.width, scene.pixel_size(kJumpPixels), marked.data());
}

EdgeKind outline_kind(const Scene::Data& scene, int u, int v) {
  EdgeKind kind = EdgeKind::kNone;
  const float z = scene.depth[scene.index(u, v)];
  const float jump = std::max(kJumpPixels * scene.pixel_size(z), kJumpNoise * scene.noise.at(z));
  for (const auto& [du, dv] : kDirections)
    for (int step = 1; step <= kGap; ++step) {
      const int nu = u + step * du, nv = v + step * dv;
      if (!scene.inside(nu, nv)) break;
      const float neighbour = scene.depth[scene.index(nu, nv)];
      if (neighbour <= 0) {
        if (step == kGap) kind = EdgeKind::kBoundary;
        continue;
      }
      if (neighbour > z + jump && neighbour > continued_depth(scene, u, v, nu, nv) + jump)
        return EdgeKind::kOccluding;
      break;
    }
  return kind;
}

bool is_crease(const Scene::Data& scene, int u, int v) {
  constexpr std::array<std::array<int, 2>, 4> kAxes = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  const float z = scene.depth[scene.index(u, v)];
  const float reach = 4 * kCreaseReach * scene.pixel_size(z);
  for (const auto& [du, dv] : kAxes) {
    const int u1 = u + kCreaseReach * du, v1 = v + kCreaseReach * dv, u2 = u - kCreaseReach * du,
              v2 = v - kCreaseReach * dv;
    if (!scene.inside(u1, v1) || !scene.inside(u2, v2)) continue;
    const size_t i1 = scene.index(u1, v1), i2 = scene.index(u2, v2);
    if (scene.smooth_depth[i1] <= 0 || scene.smooth_depth[i2] <= 0) continue;
    if (std::abs(scene.depth[i1] - z) > reach || std::abs(scene.depth[i2] - z) > reach) continue;
    if (scene.normals[i1].dot(scene.normals[i2]) < kCreaseCosine) return true;
  }
  return false;
}

}  // namespace

void detect_edges(Scene::Data& scene, int threads) {
  scene.edges.assign(scene.depth.size(), EdgeKind::kNone);
  parallel_for(static_cast<size_t>(scene.height), threads, [&](size_t row) {
    const int v = static_cast<int>(row);
    std::vector<uint8_t> marked(static_cast<size_t>(scene.width));
    mark_row(scene, v, marked);
    for (int u = 0; u < scene.width; ++u) {
      const size_t at = scene.index(u, v);
      if (scene.smooth_depth[at] <= 0) continue;
      if (marked[u]) scene.edges[at] = outline_kind(scene, u, v);
      if (scene.edges[at] == EdgeKind::kNone && is_crease(scene, u, v)) scene.edges[at] = EdgeKind::kCrease;
    }
  });
}

}  // namespace edgepose
