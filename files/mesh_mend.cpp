#include <cmath>

#include "files/mesh_demands.h"
#include "files/mesh_health.h"
#include "files/surface_measure.h"

namespace edgepose {
namespace {

void report_triangles(const MeshSurvey& survey, MeshHealth& health) {
  std::vector<std::string>& mended = health.mended;
  if (health.bad_indices)
    mended.push_back("dropped " + counted(health.bad_indices, "triangle") + " without their vertices");
  if (health.degenerate_triangles) {
    mended.push_back("dropped " + counted(health.degenerate_triangles, "triangle") + " without area");
  }
  if (health.duplicate_triangles)
    mended.push_back("dropped " + counted(health.duplicate_triangles, "doubled triangle"));
  if (health.unused_vertices) {
    mended.push_back("dropped " + counted(health.unused_vertices, "point") + " that no triangle uses");
  }
  size_t turned = 0;
  for (const SurfaceTopology::Part& part : survey.topology.parts) turned += part.turned;
  if (turned) mended.push_back("turned " + counted(turned, "triangle") + " to agree with their neighbours");
  if (health.inverted_parts) {
    mended.push_back("turned " + std::to_string(health.inverted_parts) + " of " +
                     counted(health.parts, "part") + " of the surface, which faced inwards");
  }
}

/// A normal that points to the wrong side is turned if it fits the surface otherwise, else made anew.
Eigen::Vector3f mended_normal(const Eigen::Vector3f& normal, const Eigen::Vector3f& surface) {
  const Eigen::Vector3d n = normal.cast<double>();
  switch (normal_fault(normal, surface)) {
    case NormalFault::kMissing:
      return surface;
    case NormalFault::kOpposed: {
      const Eigen::Vector3d unit = n.normalized();
      constexpr double kFits = -0.5;  // 60 degrees
      return unit.dot(surface.cast<double>()) < kFits ? Eigen::Vector3f((-unit).cast<float>()) : surface;
    }
    default:
      return n.normalized().cast<float>();
  }
}

void mend_normals(const MeshSurvey& survey, MeshHealth& health, Mesh& mesh) {
  if (!survey.has_normals) {
    mesh.normals.clear();
    return;
  }
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!survey.used[i]) continue;
    Eigen::Vector3f& normal = mesh.normals[i];
    if (!health.is_cloud) {
      normal = mended_normal(normal, survey.surface_normals[i]);
    } else if (normal_fault(normal, Eigen::Vector3f::Zero()) == NormalFault::kMissing) {
      normal.setZero();
    } else {
      normal = ((survey.cloud_inverted ? -1.0 : 1.0) * normal.cast<double>().normalized()).cast<float>();
    }
  }
  std::vector<std::string>& mended = health.mended;
  if (health.bad_normals && !health.is_cloud) {
    mended.push_back("computed " + counted(health.bad_normals, "normal") + " that had no direction");
  }
  if (health.opposed_normals) {
    mended.push_back("turned " + counted(health.opposed_normals, "normal") + " to the side of the surface");
  }
  if (survey.cloud_inverted) mended.emplace_back("turned all normals: they pointed inwards");
  if (health.non_unit_normals)
    mended.push_back("gave " + counted(health.non_unit_normals, "normal") + " unit length");
}

/// Points of a cloud whose normal has no direction cannot get one here: they go.
void settle_cloud_normals(MeshHealth& health, std::vector<bool>& keep, Mesh& cloud) {
  if (cloud.normals.empty() || health.bad_normals == 0) return;
  for (size_t i = 0; i < keep.size(); ++i) keep[i] = keep[i] && !cloud.normals[i].isZero();
  health.mended.push_back("dropped " + counted(health.bad_normals, "point") +
                          " whose normal had no direction");
}

void compact(const std::vector<bool>& keep, Mesh& mesh) {
  std::vector<uint32_t> new_index(keep.size(), 0);
  uint32_t kept = 0;
  for (size_t i = 0; i < keep.size(); ++i) {
    if (!keep[i]) continue;
    mesh.vertices[kept] = mesh.vertices[i];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[i];
    new_index[i] = kept++;
  }
  mesh.vertices.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  for (auto& triangle : mesh.triangles) {
    for (uint32_t& vertex : triangle) vertex = new_index[vertex];
  }
}

}  // namespace

Mesh mend_mesh(Mesh mesh, MeshHealth& health, const std::string& name) {
  MeshSurvey survey = survey_mesh(mesh);
  require_usable(survey, health, name);
  report_triangles(survey, health);
  mend_normals(survey, health, mesh);
  if (health.is_cloud) settle_cloud_normals(health, survey.used, mesh);
  mesh.triangles = std::move(survey.triangles);
  compact(survey.used, mesh);
  return mesh;
}

}  // namespace edgepose
