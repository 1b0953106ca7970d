#include "matcher/pixel_row.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "matcher/point_grid.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

/// Faster with a stride known at compile time.
template <typename Stride>
void take_pixels(PixelRow& row, const float* depth, const EdgeKind* edges, const Eigen::Vector3f* normals,
                 int first, Stride stride) {
  float *z = row.z.data(), *edge = row.edge.data(), *nx = row.nx.data(), *ny = row.ny.data(),
        *nz = row.nz.data();
  const size_t count = row.key.size();
  EDGEPOSE_NO_OVERLAP
  for (size_t k = 0; k < count; ++k) {
    const size_t u = static_cast<size_t>(first) + k * static_cast<size_t>(stride);
    z[k] = depth[u];
    edge[k] = edges[u] == EdgeKind::kNone ? 0.f : 1.f;
    nx[k] = normals[u].x(), ny[k] = normals[u].y(), nz[k] = normals[u].z();
  }
}

}  // namespace

void read_pixels(PixelRow& row, const float* depth, const EdgeKind* edges, const Eigen::Vector3f* normals,
                 int first, int stride) {
  if (stride == 1)
    take_pixels(row, depth, edges, normals, first, std::integral_constant<int, 1>());
  else
    take_pixels(row, depth, edges, normals, first, stride);
}

EDGEPOSE_WIDE_SIMD void place_points(PixelRow& row, const RowView& view) {
  const float *ray_x = row.ray_x.data(), *z = row.z.data(), *nx = row.nx.data(), *ny = row.ny.data(),
              *nz = row.nz.data();
  float *x = row.x.data(), *y = row.y.data(), *area = row.area.data();
  int32_t *cell_x = row.cell_x.data(), *cell_y = row.cell_y.data(), *cell_z = row.cell_z.data(),
          *noise_bin = row.noise_bin.data();
  uint64_t* key = row.key.data();
  const size_t count = row.key.size();
  constexpr float kFar = 1e9f;  // cells: what is farther is left out below, but must become a number first
  const float ray_y = view.ray_y, fx = view.fx, side_pixels = view.side, inverse_cell = view.inverse_cell;
  EDGEPOSE_NO_OVERLAP
  for (size_t k = 0; k < count; ++k) {
    const float px = z[k] * ray_x[k], py = z[k] * ray_y;
    const float facing = nx[k] * ray_x[k] + (ny[k] * ray_y + nz[k]);
    const float cosine = -facing / std::sqrt(ray_x[k] * ray_x[k] + (ray_y * ray_y + 1.f));
    const float side = z[k] / fx * side_pixels;
    area[k] = side * side / std::max(0.1f, cosine);
    x[k] = px, y[k] = py;
    cell_x[k] = static_cast<int32_t>(std::floor(std::clamp(px * inverse_cell, -kFar, kFar)));
    cell_y[k] = static_cast<int32_t>(std::floor(std::clamp(py * inverse_cell, -kFar, kFar)));
    cell_z[k] = static_cast<int32_t>(std::floor(std::clamp(z[k] * inverse_cell, -kFar, kFar)));
    noise_bin[k] = NoiseCurve::bin(z[k]);
  }
  const float max_pixel_size = view.max_pixel_size;
  const uint32_t usable = view.usable_bins;
  EDGEPOSE_NO_OVERLAP
  for (size_t k = 0; k < count; ++k) {
    const uint64_t of_cell = cell_key(cell_x[k], cell_y[k], cell_z[k]);
    uint64_t taken = z[k] > 0 ? of_cell : NormalClusterGrid::kNoKey;
    taken = z[k] / fx <= max_pixel_size ? taken : NormalClusterGrid::kNoKey;
    key[k] = usable >> noise_bin[k] & 1 ? taken : NormalClusterGrid::kNoKey;
  }
}

}  // namespace edgepose
