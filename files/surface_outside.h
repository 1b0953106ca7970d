#pragma once
#include <cstddef>
#include <vector>

#include "files/surface_topology.h"
#include "matcher/types.h"

namespace edgepose {

/// Which way each part of a surface should face.
struct OutsideVerdict {
  std::vector<bool> part_inverted;  ///< faces inwards (after the turning that the topology asks for)
  size_t inverted = 0;              ///< number of those
  size_t undecided = 0;  ///< parts that look the same from both sides, and normals do not tell either
  double inverted_area_share = 0;  ///< [0, 1] of the whole surface
};

/// A single closed part is judged by its signed volume; several parts, or open ones, by which of their sides
/// is seen from around; where that is no clear answer, by the vertex normals of the mesh. Parts that nobody
/// sees (walls of cavities) stay as they are.
OutsideVerdict find_outside(const Mesh& mesh, const SurfaceTopology& topology);

}  // namespace edgepose
