#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

enum class TriangleState : uint8_t {
  kUsable,
  kBadIndex,    ///< names a vertex that is not there
  kNonFinite,   ///< has a vertex that is NaN or infinite
  kDegenerate,  ///< has no area
  kDuplicate    ///< lies on an earlier one, the same side up
};

/// How the triangles of a mesh hang together. Vertices at the same place are one here.
struct SurfaceTopology {
  std::vector<TriangleState> state;  ///< of each triangle of the mesh
  std::vector<Eigen::Vector3f> places;

  // The connected surface: usable triangles, and needles without area, which close gaps between others.
  std::vector<std::array<uint32_t, 3>> triangles;  ///< indices into places
  std::vector<uint32_t> source;                    ///< index of each in the mesh
  std::vector<uint32_t> part;                      ///< connected piece that each belongs to
  /// Whether a triangle must be turned so that all in its part agree; the larger area of a part stays.
  std::vector<bool> turn;

  struct Part {
    double signed_volume = 0;  ///< [m^3] about the centre of the places, after turning
    size_t turned = 0;         ///< triangles to turn
    bool closed = true;        ///< no open edge, none with more than two triangles
    bool orientable = true;    ///< false: a Moebius strip
  };
  std::vector<Part> parts;
  size_t edges = 0, open_edges = 0, non_manifold_edges = 0, inconsistent_edges = 0;
};

SurfaceTopology find_topology(const Mesh& mesh);

}  // namespace edgepose
