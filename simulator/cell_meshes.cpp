#include "simulator/cell_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace edgepose {
namespace {

struct Ring {
  double behind, radius;  // [m]
};
/// From the tip on.
constexpr std::array<Ring, 9> kDrillRings{{{0, 0.0001},
                                           {0.004, 0.0025},
                                           {0.070, 0.0025},
                                           {0.072, 0.006},
                                           {0.150, 0.006},
                                           {0.160, 0.012},
                                           {0.200, 0.012},
                                           {0.205, 0.022},
                                           {1, 0.022}}};
constexpr uint32_t kSides = 32;

}  // namespace

Mesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                                 (i & 4) != 0 ? high.z() : low.z());
    mesh.vertices.emplace_back(corner.cast<float>());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

double drill_radius(double behind) {
  for (size_t i = 1; i < kDrillRings.size(); ++i) {
    const Ring &from = kDrillRings[i - 1], &to = kDrillRings[i];
    if (behind > to.behind) continue;
    const double share = (std::max(behind, 0.0) - from.behind) / (to.behind - from.behind);
    return from.radius + share * (to.radius - from.radius);
  }
  return kDrillRings.back().radius;
}

Mesh drill_mesh(double length) {
  Mesh mesh;
  uint32_t rings = 0;
  for (const Ring& ring : kDrillRings) {
    const double behind = std::min(ring.behind, length);
    for (uint32_t side = 0; side < kSides; ++side) {
      const double turn = 2 * std::numbers::pi * side / kSides, radius = drill_radius(behind);
      mesh.vertices.emplace_back(
          Eigen::Vector3d(radius * std::cos(turn), radius * std::sin(turn), -behind).cast<float>());
    }
    ++rings;
    if (ring.behind >= length) break;
  }
  for (uint32_t ring = 0; ring + 1 < rings; ++ring)
    for (uint32_t side = 0; side < kSides; ++side) {
      const uint32_t a = ring * kSides + side, b = ring * kSides + (side + 1) % kSides;
      mesh.triangles.push_back({a, a + kSides, b});
      mesh.triangles.push_back({b, a + kSides, b + kSides});
    }
  for (uint32_t side = 1; side + 1 < kSides; ++side) {  // flat ends
    mesh.triangles.push_back({0, side, side + 1});
    const uint32_t last = (rings - 1) * kSides;
    mesh.triangles.push_back({last, last + side + 1, last + side});
  }
  return mesh;
}

}  // namespace edgepose
