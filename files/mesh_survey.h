#pragma once
#include <vector>

#include "files/surface_outside.h"
#include "files/surface_topology.h"
#include "matcher/types.h"

namespace edgepose {

/// Everything about a mesh that both check_mesh() and mend_mesh() need to know.
struct MeshSurvey {
  SurfaceTopology topology;
  OutsideVerdict outside;

  std::vector<std::array<uint32_t, 3>> triangles;  ///< the usable ones, turned outwards; indices of the mesh
  std::vector<bool> used;                          ///< vertices: in one of these triangles (cloud: finite)
  /// Normal of each vertex from these triangles; zero if not used. Empty for a cloud.
  std::vector<Eigen::Vector3f> surface_normals;
  bool has_normals = false;     ///< one for each vertex
  bool cloud_inverted = false;  ///< a cloud whose normals point to its middle
  std::vector<Eigen::Vector3f> used_vertices;
};

MeshSurvey survey_mesh(const Mesh& mesh);

/// What is wrong with a vertex normal, given the surface's.
enum class NormalFault { kNone, kMissing, kOpposed, kLength };
NormalFault normal_fault(const Eigen::Vector3f& normal, const Eigen::Vector3f& surface_normal);

}  // namespace edgepose
