#include "files/mesh_demands.h"

#include <algorithm>

#include "common/error.h"
#include "files/number_text.h"

namespace edgepose {
namespace {

void require_numbers(const MeshSurvey& survey, const MeshHealth& health, const std::string& name) {
  if (health.vertices == 0) throw InputError::at(name, "a mesh or cloud with vertices", "none");
  if (health.non_finite_vertices) {
    throw InputError::at(name, "finite coordinates",
                         std::to_string(health.non_finite_vertices) + " of " +
                             counted(health.vertices, "vertex", "vertices") + " NaN or infinite",
                         "export the model again or remove these points");
  }
  // Single ones come from slivers; if all are zero, they were never computed.
  if (survey.has_normals && health.bad_normals > 0 && health.bad_normals == survey.used_vertices.size()) {
    throw InputError::at(name, "normals with a direction", "only zero or NaN ones",
                         health.is_cloud ? "compute the cloud's normals, pointing outwards"
                                         : "remove the normals, then they are computed from the triangles");
  }
}

void require_surface(const MeshSurvey& survey, const MeshHealth& health, const std::string& name) {
  if (!health.is_cloud && survey.triangles.empty()) {
    throw InputError::at(name, "a mesh with usable triangles",
                         counted(health.triangles, "triangle") +
                             ", all without area, or with vertices that are not finite or not there");
  }
  const std::string complaint = health.size_complaint();
  if (!complaint.empty()) throw InputError::at(name, "an object of plausible size", complaint);
  float farthest = 0;
  for (const Eigen::Vector3f& vertex : survey.used_vertices)
    farthest = std::max(farthest, vertex.cwiseAbs().maxCoeff());
  if (static_cast<double>(farthest) > kMaxCoordinate) {
    throw InputError::at(name, "coordinates within " + number_text(kMaxCoordinate) + " m of the origin",
                         number_text(static_cast<double>(farthest), 3) + " m",
                         "move the object to the origin: so far away, coordinates lose their precision");
  }
}

}  // namespace

std::string counted(size_t count, const std::string& thing, const std::string& things) {
  return std::to_string(count) + " " + (count == 1 ? thing : things.empty() ? thing + "s" : things);
}

void require_usable(const MeshSurvey& survey, const MeshHealth& health, const std::string& name) {
  require_numbers(survey, health, name);
  require_surface(survey, health, name);
}

}  // namespace edgepose
