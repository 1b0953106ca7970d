#include "files/mesh_health.h"

#include <algorithm>
#include <cmath>

#include "files/mesh_survey.h"
#include "files/number_text.h"
#include "files/surface_measure.h"

namespace edgepose {
namespace {

std::string percent(double share) {
  const double value = 100 * share;
  return number_text(value < 99.5 ? value : std::round(value), value < 99.5 ? 2 : 3) + " %";
}

void count_vertices_and_triangles(const Mesh& mesh, const MeshSurvey& survey, MeshHealth& health) {
  health.vertices = mesh.vertices.size();
  health.triangles = mesh.triangles.size();
  health.is_cloud = mesh.triangles.empty();
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite()) {
      ++health.non_finite_vertices;
    } else if (!survey.used[i]) {
      ++health.unused_vertices;
    }
  }
  for (const TriangleState state : survey.topology.state) {
    health.bad_indices += state == TriangleState::kBadIndex;
    health.degenerate_triangles += state == TriangleState::kDegenerate || state == TriangleState::kNonFinite;
    health.duplicate_triangles += state == TriangleState::kDuplicate;
  }
}

void count_edges_and_parts(const MeshSurvey& survey, MeshHealth& health) {
  const SurfaceTopology& topology = survey.topology;
  health.edges = topology.edges;
  health.open_edges = topology.open_edges;
  health.non_manifold_edges = topology.non_manifold_edges;
  health.inconsistent_edges = topology.inconsistent_edges;
  health.parts = topology.parts.size();
  health.inverted_parts = survey.outside.inverted;
  health.undecided_parts = survey.outside.undecided;
  for (const SurfaceTopology::Part& part : topology.parts) {
    health.signed_volume += part.signed_volume;
    health.unorientable_parts += !part.orientable;
  }
  health.inverted = survey.cloud_inverted || survey.outside.inverted_area_share > 0.5;
}

void count_normals(const Mesh& mesh, const MeshSurvey& survey, MeshHealth& health) {
  if (!survey.has_normals) return;
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!survey.used[i]) continue;
    const Eigen::Vector3f surface = health.is_cloud ? Eigen::Vector3f::Zero() : survey.surface_normals[i];
    const NormalFault fault = normal_fault(mesh.normals[i], surface);
    health.bad_normals += fault == NormalFault::kMissing;
    health.opposed_normals += fault == NormalFault::kOpposed;
    health.non_unit_normals += fault == NormalFault::kLength;
  }
}

void add_warnings(const Mesh& mesh, const MeshSurvey& survey, MeshHealth& health) {
  std::vector<std::string>& warnings = health.warnings;
  if (health.is_cloud && !survey.has_normals) {
    warnings.emplace_back(
        "a cloud without triangles and without normals: which side is outside is not known");
  } else if (health.is_cloud) {
    warnings.emplace_back("a cloud without triangles: the surface between the points is not known");
  }
  if (!mesh.normals.empty() && !survey.has_normals) {
    warnings.push_back(std::to_string(mesh.normals.size()) + " normals for " +
                       std::to_string(health.vertices) + " vertices: they are ignored");
  }
  if (health.open_edges > 0) {
    warnings.push_back("open mesh: " + std::to_string(health.open_edges) + " of " +
                       std::to_string(health.edges) + " edges (" + percent(health.open_edge_share()) +
                       ") have a triangle on one side only");
  }
  if (health.non_manifold_edges > 0) {
    warnings.push_back(std::to_string(health.non_manifold_edges) + " edges have more than two triangles");
  }
  if (health.undecided_parts > 0) {
    warnings.push_back(
        std::to_string(health.undecided_parts) + " of " + std::to_string(health.parts) +
        " parts of the surface look the same from both sides: if no match is found, turn their normals");
  }
  if (health.unorientable_parts > 0) {
    warnings.push_back(
        std::to_string(health.unorientable_parts) +
        " parts of the surface have one side only (as a Moebius strip has): no normals are right");
  }
}

std::string size_text(double metres) {
  return metres < 1 ? number_text(1000 * metres, 3) + " mm" : number_text(metres, 3) + " m";
}

}  // namespace

std::string MeshHealth::size_complaint() const {
  if (diameter >= limits.min_diameter && diameter <= limits.max_diameter) return "";
  std::string complaint = "a diameter of " + size_text(diameter) + ", outside " +
                          size_text(limits.min_diameter) + " to " + size_text(limits.max_diameter);
  const std::string advice = "; if that is its true size, give --any-size";
  const bool small = diameter < limits.min_diameter;
  const double other = small ? diameter * 1000 : diameter / 1000;
  if (other < limits.min_diameter || other > limits.max_diameter) return complaint + advice;
  return complaint + ": the file seems to be in " +
         (small ? "metres, not millimetres" : "millimetres, not metres") + " (it would be " +
         size_text(other) + " with --unit " + (small ? "m" : "mm") + ")" + advice;
}

MeshHealth check_mesh(const Mesh& mesh, const MeshLimits& limits) {
  MeshHealth health;
  health.limits = limits;
  const MeshSurvey survey = survey_mesh(mesh);
  count_vertices_and_triangles(mesh, survey, health);
  count_edges_and_parts(survey, health);
  count_normals(mesh, survey, health);
  health.diameter = estimate_diameter(survey.used_vertices);
  add_warnings(mesh, survey, health);
  return health;
}

}  // namespace edgepose
