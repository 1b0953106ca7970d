#include "files/mesh_survey.h"

#include <algorithm>
#include <cmath>

#include "files/surface_measure.h"

namespace edgepose {
namespace {

/// Normals of a closed surface point away from its middle on the whole, those of a scan to the sensor before
/// it; for a ball the share is 1 or -1.
bool points_inwards(const Mesh& cloud) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  size_t count = 0;
  for (const Eigen::Vector3f& point : cloud.vertices) {
    if (!point.allFinite()) continue;
    middle += point.cast<double>();
    ++count;
  }
  if (count == 0) return false;
  middle /= static_cast<double>(count);
  double outwards = 0, all = 0;
  for (size_t i = 0; i < cloud.vertices.size(); ++i) {
    if (!cloud.vertices[i].allFinite() || !cloud.normals[i].allFinite()) continue;
    const Eigen::Vector3d normal = cloud.normals[i].cast<double>().normalized();
    const Eigen::Vector3d arm = cloud.vertices[i].cast<double>() - middle;
    outwards += normal.dot(arm);
    all += arm.norm();
  }
  constexpr double kClearly = -0.2;
  return outwards < kClearly * all;
}

/// Usable triangles, each turned so that its part agrees and faces outwards.
std::vector<std::array<uint32_t, 3>> outward_triangles(const Mesh& mesh, const SurfaceTopology& topology,
                                                       const OutsideVerdict& outside) {
  std::vector<std::array<uint32_t, 3>> triangles;
  for (size_t t = 0; t < topology.triangles.size(); ++t) {
    if (topology.state[topology.source[t]] != TriangleState::kUsable) continue;
    std::array<uint32_t, 3> triangle = mesh.triangles[topology.source[t]];
    if (topology.turn[t] != outside.part_inverted[topology.part[t]]) std::swap(triangle[1], triangle[2]);
    triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace

MeshSurvey survey_mesh(const Mesh& mesh) {
  MeshSurvey survey;
  survey.has_normals = !mesh.normals.empty() && mesh.normals.size() == mesh.vertices.size();
  survey.used.assign(mesh.vertices.size(), false);
  if (mesh.triangles.empty()) {
    for (size_t i = 0; i < mesh.vertices.size(); ++i) survey.used[i] = mesh.vertices[i].allFinite();
    survey.cloud_inverted = survey.has_normals && points_inwards(mesh);
  } else {
    survey.topology = find_topology(mesh);
    survey.outside = find_outside(mesh, survey.topology);
    survey.triangles = outward_triangles(mesh, survey.topology, survey.outside);
    survey.surface_normals = normals_from_triangles(mesh.vertices, survey.triangles);
    for (const auto& triangle : survey.triangles) {
      for (const uint32_t vertex : triangle) survey.used[vertex] = true;
    }
  }
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (survey.used[i]) survey.used_vertices.push_back(mesh.vertices[i]);
  }
  return survey;
}

NormalFault normal_fault(const Eigen::Vector3f& normal, const Eigen::Vector3f& surface_normal) {
  const Eigen::Vector3d n = normal.cast<double>();
  const double length = n.norm();
  if (!std::isfinite(length) || length < 1e-6) return NormalFault::kMissing;
  if (n.dot(surface_normal.cast<double>()) < 0) return NormalFault::kOpposed;
  constexpr double kLengthTolerance = 0.01;
  return std::abs(length - 1) > kLengthTolerance ? NormalFault::kLength : NormalFault::kNone;
}

}  // namespace edgepose
