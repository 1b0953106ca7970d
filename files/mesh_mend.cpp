#include <cmath>

#include "common/error.h"
#include "files/mesh_health.h"
#include "files/mesh_survey.h"
#include "files/surface_measure.h"

namespace edgepose {
namespace {

/// "1 triangle", "3 triangles".
std::string counted(size_t count, const char* thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

void require_surface(const MeshSurvey& survey, const MeshHealth& health, const std::string& name) {
  if (health.is_cloud && survey.used_vertices.empty()) {
    throw InputError::at(name, "a mesh or cloud with finite points",
                         counted(health.vertices, "point") + ", none of them finite");
  }
  if (!health.is_cloud && survey.triangles.empty()) {
    throw InputError::at(name, "a mesh with usable triangles",
                         counted(health.triangles, "triangle") +
                             ", all without area, or with vertices that are not finite or not there");
  }
  const std::string complaint = health.size_complaint();
  if (!complaint.empty()) throw InputError::at(name, "an object of plausible size", complaint);
}

void report_triangles(const MeshSurvey& survey, MeshHealth& health) {
  std::vector<std::string>& mended = health.mended;
  if (health.bad_indices)
    mended.push_back("dropped " + counted(health.bad_indices, "triangle") + " without their vertices");
  if (health.non_finite_vertices) {
    mended.push_back("dropped what is not finite: " + counted(health.non_finite_vertices, "point") +
                     (health.is_cloud ? "" : " and the triangles at them"));
  }
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

/// Points of a cloud without a direction cannot get one here: they go, or, if no point has one, the normals
/// do.
void settle_cloud_normals(MeshHealth& health, std::vector<bool>& keep, Mesh& cloud) {
  if (cloud.normals.empty() || health.bad_normals == 0) return;
  bool any = false;
  for (size_t i = 0; i < keep.size(); ++i) any = any || (keep[i] && !cloud.normals[i].isZero());
  if (!any) {
    cloud.normals.clear();
    health.mended.emplace_back("dropped the normals: none had a direction");
    return;
  }
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
  require_surface(survey, health, name);
  report_triangles(survey, health);
  mend_normals(survey, health, mesh);
  if (health.is_cloud) settle_cloud_normals(health, survey.used, mesh);
  mesh.triangles = std::move(survey.triangles);
  compact(survey.used, mesh);
  return mesh;
}

}  // namespace edgepose
