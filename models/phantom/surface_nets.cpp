#include "models/phantom/surface_nets.h"

#include <array>
#include <cmath>

namespace edgepose::phantom {
namespace {

using Eigen::Vector3d;
using Index = std::array<int, 3>;

/// Corners of a grid with the function's value at each.
struct Grid {
  Vector3d origin;
  double cell;
  Index corners;  // number along x, y, z
  std::vector<double> value;

  size_t flat(const Index& i) const {
    return (static_cast<size_t>(i[2]) * corners[1] + static_cast<size_t>(i[1])) * corners[0] +
           static_cast<size_t>(i[0]);
  }
  Vector3d position(const Index& i) const { return origin + cell * Vector3d(i[0], i[1], i[2]); }
  bool inside(const Index& i) const { return value[flat(i)] < 0; }

  template <typename Visit>
  void for_each(int first, int last_offset, const Visit& visit) const {
    for (int z = first; z < corners[2] + last_offset; ++z) {
      for (int y = first; y < corners[1] + last_offset; ++y) {
        for (int x = first; x < corners[0] + last_offset; ++x) visit(Index{x, y, z});
      }
    }
  }
};

Index moved(Index i, int axis, int by) {
  i[static_cast<size_t>(axis)] += by;
  return i;
}

/// Mean of the points where the surface crosses the edges of the cell; false if it crosses none.
bool mean_crossing(const Grid& grid, const Index& cell, Vector3d& mean) {
  mean.setZero();
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int edge = 0; edge < 4; ++edge) {
      const Index a = moved(moved(cell, (axis + 1) % 3, edge & 1), (axis + 2) % 3, edge >> 1);
      const Index b = moved(a, axis, 1);
      if (grid.inside(a) == grid.inside(b)) continue;
      const double at_a = grid.value[grid.flat(a)], at_b = grid.value[grid.flat(b)];
      mean += grid.position(a) + (at_a / (at_a - at_b)) * (grid.position(b) - grid.position(a));
      ++crossings;
    }
  }
  if (crossings > 0) mean /= crossings;
  return crossings > 0;
}

}  // namespace

Mesh surface_nets(const std::function<double(const Vector3d&)>& distance,
                  const std::function<Vector3d(const Vector3d&)>& normal, const Vector3d& box_min,
                  const Vector3d& box_max, double cell) {
  Grid grid{box_min, cell, {}, {}};
  size_t total = 1;
  for (size_t axis = 0; axis < 3; ++axis) {
    grid.corners[axis] = static_cast<int>(std::ceil((box_max[axis] - box_min[axis]) / cell)) + 1;
    total *= static_cast<size_t>(grid.corners[axis]);
  }
  grid.value.resize(total);
  grid.for_each(0, 0, [&](const Index& i) { grid.value[grid.flat(i)] = distance(grid.position(i)); });

  Mesh mesh;
  std::vector<uint32_t> vertex_of(total, UINT32_MAX);  // of the cell whose lowest corner it is
  grid.for_each(0, -1, [&](const Index& i) {
    Vector3d point;
    if (!mean_crossing(grid, i, point)) return;
    for (int step = 0; step < 3; ++step) point -= 0.9 * distance(point) * normal(point);
    vertex_of[grid.flat(i)] = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(point.cast<float>());
    mesh.normals.emplace_back(normal(point).cast<float>());
  });

  grid.for_each(1, -1, [&](const Index& i) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool begins_inside = grid.inside(i);
      if (begins_inside == grid.inside(moved(i, axis, 1))) continue;
      // The four cells about the edge, counter-clockwise seen from its far end.
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<uint32_t, 4> quad = {vertex_of[grid.flat(moved(moved(i, u, -1), v, -1))],
                                      vertex_of[grid.flat(moved(i, v, -1))], vertex_of[grid.flat(i)],
                                      vertex_of[grid.flat(moved(i, u, -1))]};
      if (!begins_inside) std::swap(quad[1], quad[3]);
      const auto squared = [&](int a, int b) {
        return (mesh.vertices[quad[static_cast<size_t>(a)]] - mesh.vertices[quad[static_cast<size_t>(b)]])
            .squaredNorm();
      };
      if (squared(0, 2) <= squared(1, 3)) {  // the shorter diagonal
        mesh.triangles.push_back({quad[0], quad[1], quad[2]});
        mesh.triangles.push_back({quad[0], quad[2], quad[3]});
      } else {
        mesh.triangles.push_back({quad[0], quad[1], quad[3]});
        mesh.triangles.push_back({quad[1], quad[2], quad[3]});
      }
    }
  });
  return mesh;
}

}  // namespace edgepose::phantom
