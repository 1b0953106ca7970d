#pragma once
#include <cstddef>
#include <vector>

#include "files/surface_topology.h"

namespace edgepose {

/// How much of a part of a surface is seen from outside: pixels summed over views from all around.
struct SeenSides {
  size_t front = 0;  ///< where its triangles (turned as the topology says) face the viewer
  size_t back = 0;   ///< where they face away
  size_t total() const { return front + back; }
  double back_share() const {
    return total() ? static_cast<double>(back) / static_cast<double>(total()) : 0.0;
  }
};

/// Draws the surface from 12 directions, orthographic, 128 x 128 pixels, and looks which side of which part
/// is in front. Some 25 ms for 60,000 triangles.
std::vector<SeenSides> look_from_around(const SurfaceTopology& topology);

}  // namespace edgepose
