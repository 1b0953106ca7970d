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
constexpr int kRowsPerEdgeJob = 32;
constexpr std::array<std::array<int, 2>, 4> kDirections = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

/// Depth at which the pixel's plane continues in the neighbouring pixel.
float continued_depth(const Scene::Data& scene, int u, int v, int nu, int nv) {
  const size_t at = scene.index(u, v);
  const Eigen::Vector3f& normal = scene.normals[at];
  const float slant = normal.dot(scene.ray(nu, nv));
  if (slant > -0.05f) return scene.depth[at];  // grazing: the continuation says nothing
  return normal.dot(scene.smooth_point(u, v)) / slant;
}

/// The pixels one to kGap away in one of the four directions.
struct Beside {
  std::array<const float*, kGap> depth;  // rows, shifted
};

/// Marks the pixels of row v that could be an outline: nothing measured as far as a jump can hide, or a step
/// that is large enough, in one of the four directions. Few pixels are left to look at closely.
EDGEPOSE_WIDE_SIMD void mark_steps(const float* centre, std::array<Beside, kDirections.size()> sides,
                                   int width, float jump_for_depth, uint8_t* marked) {
  EDGEPOSE_NO_OVERLAP
  for (int u = kGap; u < width - kGap; ++u) {
    float emptiest = centre[u], most = centre[u];
#pragma GCC unroll 4
    for (const Beside& side : sides) {
      const float highest = std::max(std::max(side.depth[0][u], side.depth[1][u]), side.depth[2][u]);
      emptiest = std::min(emptiest, highest);
      most = std::max(most, highest);
    }
    marked[u] = emptiest <= 0 || most > centre[u] + jump_for_depth * centre[u] ? 1 : 0;
  }
}

/// For each pixel of row v whether outline_kind() need look at it.
void mark_row(const Scene::Data& scene, int v, std::vector<uint8_t>& marked) {
  std::fill(marked.begin(), marked.end(), uint8_t{1});
  if (v < kGap || v >= scene.height - kGap) return;
  const float* centre = scene.depth.data() + scene.index(0, v);
  std::array<Beside, kDirections.size()> sides;
  for (size_t i = 0; i < sides.size(); ++i)
    for (int k = 0; k < kGap; ++k)
      sides[i].depth[k] = centre + (k + 1) * (kDirections[i][0] + kDirections[i][1] * scene.width);
  mark_steps(centre, sides, scene.width, scene.pixel_size(kJumpPixels), marked.data());
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

/// Rows of the image whose normals stand apart by coordinate, so that pixels are compared side by side.
class NormalRows {
 public:
  NormalRows(const Scene::Data& scene, int first, int last)
      : first_(std::max(0, first)), width_(static_cast<size_t>(scene.width)) {
    const int end = std::min(scene.height, last);
    const size_t count = static_cast<size_t>(end - first_) * width_;
    x_.resize(count), y_.resize(count), z_.resize(count);
    const Eigen::Vector3f* normals = scene.normals.data() + scene.index(0, first_);
    for (size_t i = 0; i < count; ++i) x_[i] = normals[i].x(), y_[i] = normals[i].y(), z_[i] = normals[i].z();
  }
  struct Row {
    const float *x, *y, *z;
  };
  Row row(int v) const {
    const size_t at = static_cast<size_t>(v - first_) * width_;
    return {x_.data() + at, y_.data() + at, z_.data() + at};
  }

 private:
  int first_;
  size_t width_;
  std::vector<float> x_, y_, z_;
};

/// One side of a possible crease: a row of the image, shifted.
struct Side {
  const float *x, *y, *z;  // normals
  const float *depth, *smooth_depth;
};

/// Marks the pixels whose two sides belong to the same surface and face different ways.
EDGEPOSE_WIDE_SIMD void mark_creases(const float* depth, Side one, Side other, int first, int last,
                                     float reach_for_depth, int32_t* marked) {
  EDGEPOSE_NO_OVERLAP
  for (int u = first; u < last; ++u) {
    const float reach = reach_for_depth * depth[u];
    const float cosine = one.x[u] * other.x[u] + one.y[u] * other.y[u] + one.z[u] * other.z[u];
    int32_t crease = cosine < kCreaseCosine ? 1 : 0;
    crease = one.smooth_depth[u] > 0 ? crease : 0;
    crease = other.smooth_depth[u] > 0 ? crease : 0;
    crease = std::abs(one.depth[u] - depth[u]) <= reach ? crease : 0;
    crease = std::abs(other.depth[u] - depth[u]) <= reach ? crease : 0;
    marked[u] |= crease;
  }
}

/// For each pixel of row v whether the surface bends there, in any of four directions.
void mark_crease_row(const Scene::Data& scene, const NormalRows& normals, int v,
                     std::vector<int32_t>& marked) {
  constexpr std::array<std::array<int, 2>, 4> kAxes = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  std::fill(marked.begin(), marked.end(), 0);
  for (const auto& [du, dv] : kAxes) {
    const int shift = kCreaseReach * du, v1 = v + kCreaseReach * dv, v2 = v - kCreaseReach * dv;
    if (std::min(v1, v2) < 0 || std::max(v1, v2) >= scene.height) continue;
    const auto side = [&](int row, int shifted) -> Side {
      const NormalRows::Row n = normals.row(row);
      const size_t at = scene.index(0, row);
      return {n.x + shifted, n.y + shifted, n.z + shifted, scene.depth.data() + at + shifted,
              scene.smooth_depth.data() + at + shifted};
    };
    mark_creases(scene.depth.data() + scene.index(0, v), side(v1, shift), side(v2, -shift), shift,
                 scene.width - shift, scene.pixel_size(4 * kCreaseReach), marked.data());
  }
}

constexpr int kPixelsAtOnce = 16;  // most of the image holds no edge

bool nothing_marked(const uint8_t* stepped, const int32_t* creased, int count) {
  int32_t any = 0;
  for (int k = 0; k < count; ++k) any |= stepped[k] | creased[k];
  return any == 0;
}

}  // namespace

void detect_edges(Scene::Data& scene, int threads) {
  scene.edges.assign(scene.depth.size(), EdgeKind::kNone);
  const size_t jobs = static_cast<size_t>((scene.height + kRowsPerEdgeJob - 1) / kRowsPerEdgeJob);
  parallel_for(jobs, threads, [&](size_t job) {
    const int first = static_cast<int>(job) * kRowsPerEdgeJob,
              last = std::min(scene.height, first + kRowsPerEdgeJob);
    const NormalRows normals(scene, first - kCreaseReach, last + kCreaseReach);
    std::vector<uint8_t> stepped(static_cast<size_t>(scene.width));
    std::vector<int32_t> creased(stepped.size());
    for (int v = first; v < last; ++v) {
      mark_row(scene, v, stepped);
      mark_crease_row(scene, normals, v, creased);
      for (int u = 0; u < scene.width; u += kPixelsAtOnce) {
        const int end = std::min(u + kPixelsAtOnce, scene.width);
        if (nothing_marked(stepped.data() + u, creased.data() + u, end - u)) continue;
        for (int k = u; k < end; ++k) {
          const size_t at = scene.index(k, v);
          if (scene.smooth_depth[at] <= 0) continue;
          EdgeKind kind = stepped[k] ? outline_kind(scene, k, v) : EdgeKind::kNone;
          if (kind == EdgeKind::kNone && creased[k]) kind = EdgeKind::kCrease;
          scene.edges[at] = kind;
        }
      }
    }
  });
}

}  // namespace edgepose
