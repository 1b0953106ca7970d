#pragma once
#include <cstdint>
#include <vector>

#include "matcher/normal_clusters.h"
#include "matcher/scene_data.h"

namespace edgepose {

/// What one row of pixels is seen with.
struct RowView {
  float ray_y;
  float fx;              // pixels
  float side;            // pixels that one stands for
  float max_pixel_size;  // [m]
  float inverse_cell;    // [1/m]
  uint32_t usable_bins;  // a bit for each bin of the noise curve
};

/// The points of some pixels of a row; structure of arrays, so that the compiler vectorises over the pixels.
struct PixelRow {
  explicit PixelRow(size_t count)
      : ray_x(count),
        x(count),
        y(count),
        z(count),
        nx(count),
        ny(count),
        nz(count),
        area(count),
        edge(count),
        cell_x(count),
        cell_y(count),
        cell_z(count),
        noise_bin(count),
        key(count),
        cell(count),
        run(count),
        run_key(count + 1),
        run_cell(count + 1) {}
  PointRow points() const {
    return {cell.data(), x.data(),  y.data(),    z.data(),    nx.data(),
            ny.data(),   nz.data(), area.data(), edge.data(), cell.size()};
  }

  std::vector<float> ray_x, x, y, z, nx, ny, nz;
  std::vector<float> area;  // [m^2] of the surface
  std::vector<float> edge;
  std::vector<int32_t> cell_x, cell_y, cell_z;
  std::vector<int32_t> noise_bin;
  std::vector<uint64_t> key;   // of the cell; kNoKey for a pixel that is left out
  std::vector<uint32_t> cell;  // its number; 0 for a pixel that is left out
  std::vector<uint32_t> run;   // of pixels in the same cell, from 1 on
  std::vector<uint64_t> run_key;
  std::vector<uint32_t> run_cell;
};

/// Takes over depths, edges and normals of every stride-th pixel of a row, from column `first` on.
void read_pixels(PixelRow& row, const float* depth, const EdgeKind* edges, const Eigen::Vector3f* normals,
                 int first, int stride);

/// Works out the points, their areas and cells from what read_pixels() left.
void place_points(PixelRow& row, const RowView& view);

}  // namespace edgepose
