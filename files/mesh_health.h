#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// What counts as a plausible object. Metres.
struct MeshLimits {
  double min_diameter = 0.005;  ///< [m] anything smaller was most likely read in the wrong unit
  double max_diameter = 5.0;    ///< [m] anything larger too
};
/// For objects of which somebody knows that they are so small or large: what the matcher can hold.
inline constexpr MeshLimits kAnySize = {1e-3, 100.0};
/// [m] coordinates beyond have lost their millimetres (they are 32-bit numbers).
inline constexpr double kMaxCoordinate = 1000;

/// How sound a mesh is. Counts describe the mesh as check_mesh() saw it; vertices at the same place count as
/// one for edges and orientation, so meshes with split vertices (hard edges, texture seams) are closed too.
struct MeshHealth {
  MeshLimits limits;
  size_t vertices = 0, triangles = 0;
  size_t non_finite_vertices = 0;   ///< NaN or infinite
  size_t unused_vertices = 0;       ///< in no triangle (0 for a cloud)
  size_t bad_indices = 0;           ///< triangles that name a vertex that is not there
  size_t degenerate_triangles = 0;  ///< without area, or with a vertex that is not finite
  size_t duplicate_triangles = 0;   ///< the same three places in the same orientation once more
  size_t bad_normals = 0;           ///< zero or not finite
  size_t non_unit_normals = 0;      ///< length differs from 1 by more than 1 %, not counting bad ones
  size_t opposed_normals = 0;       ///< more than 90 degrees from the surface, once that faces outwards
  size_t edges = 0;                 ///< of the usable triangles
  size_t open_edges = 0;            ///< with a triangle on one side only
  size_t non_manifold_edges = 0;    ///< with more than two triangles
  size_t inconsistent_edges = 0;    ///< whose two triangles disagree about the outside
  size_t parts = 0;                 ///< connected pieces of surface
  size_t inverted_parts = 0;        ///< of them, those that face inwards
  size_t undecided_parts = 0;       ///< of them, open ones that look the same from both sides
  size_t unorientable_parts = 0;    ///< of them, those with one side only (Moebius strip)
  double signed_volume = 0;         ///< [m^3] negative: inside out (means something only if closed)
  double diameter = 0;              ///< [m] largest distance between two used points; rarely 1 % too small
  bool is_cloud = false;            ///< no triangles
  bool inverted = false;            ///< normals or triangles point inwards

  std::vector<std::string> mended;    ///< what mend_mesh() did, a line each
  std::vector<std::string> warnings;  ///< what cannot be mended but need not stop anyone, a line each

  bool closed() const { return edges > 0 && open_edges == 0 && non_manifold_edges == 0; }
  double open_edge_share() const {
    return edges ? static_cast<double>(open_edges) / static_cast<double>(edges) : 0.0;
  }
  /// Empty if the diameter is within the limits, else one line with the unit that would make sense.
  std::string size_complaint() const;
};

/// Looks at a mesh or cloud (in metres) and changes nothing. Never throws on bad content.
MeshHealth check_mesh(const Mesh& mesh, const MeshLimits& limits = {});

/// Mends what can be mended and says so in `health.mended`: drops degenerate, duplicate and dangling faces;
/// unused vertices; makes the orientation of each part consistent and outwards; recomputes single normals
/// without a direction (in a cloud it drops their points), turns opposed ones and normalises the others.
/// `health` is what check_mesh() found in this mesh; `name` (of the file) starts the error.
/// Throws InputError if a vertex is not finite, if there are normals but none has a direction, if nothing
/// usable is left, or if the size or the place is implausible.
Mesh mend_mesh(Mesh mesh, MeshHealth& health, const std::string& name = "mesh");

}  // namespace edgepose
