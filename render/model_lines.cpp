#include "render/model_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace edgepose::internal {
namespace {

using Eigen::Vector3d;

/// Triangles over vertices of which no two lie in the same place (CAD files repeat them at each face).
struct Welded {
  std::vector<Vector3d> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<Vector3d> area_normals;  // per triangle; length = twice the area
};

Welded weld(const Mesh& mesh) {
  Welded result;
  std::map<std::tuple<float, float, float>, uint32_t> index_of;
  std::vector<uint32_t> welded(mesh.vertices.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = mesh.vertices[i];
    const auto [entry, is_new] =
        index_of.try_emplace({p.x(), p.y(), p.z()}, static_cast<uint32_t>(result.vertices.size()));
    if (is_new) result.vertices.emplace_back(p.cast<double>());
    welded[i] = entry->second;
  }
  for (const auto& t : mesh.triangles) {
    const std::array<uint32_t, 3> triangle = {welded[t[0]], welded[t[1]], welded[t[2]]};
    const Vector3d& a = result.vertices[triangle[0]];
    const Vector3d ab = result.vertices[triangle[1]] - a, ac = result.vertices[triangle[2]] - a;
    const Vector3d normal = ab.cross(ac);
    if (normal.squaredNorm() == 0) continue;
    result.triangles.push_back(triangle);
    result.area_normals.push_back(normal);
  }
  return result;
}

double cosine(const Vector3d& a, const Vector3d& b) {
  return a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm());
}

/// Leaves out the lines that hang together over less than `min_length`: on a smooth but finely curved mesh
/// single edges are sharp, and no line that anybody sees.
void add_long_lines(const Welded& mesh, const std::vector<std::pair<uint32_t, uint32_t>>& edges,
                    double min_length, std::vector<LinePiece>& lines) {
  std::map<uint32_t, uint32_t> parent;  // union-find over the vertices
  const auto root = [&](uint32_t vertex) {
    while (parent.try_emplace(vertex, vertex).first->second != vertex) {
      vertex = parent[vertex] = parent[parent[vertex]];
    }
    return vertex;
  };
  const auto length = [&](const auto& edge) {
    return (mesh.vertices[edge.first] - mesh.vertices[edge.second]).norm();
  };
  for (const auto& [a, b] : edges) parent[root(a)] = root(b);
  std::map<uint32_t, double> total;
  for (const auto& edge : edges) total[root(edge.first)] += length(edge);
  for (const auto& edge : edges) {
    if (total[root(edge.first)] < min_length) continue;
    lines.push_back({mesh.vertices[edge.first], mesh.vertices[edge.second]});
  }
}

void add_creases(const Welded& mesh, const Vector3d& viewpoint, double min_cosine,
                 std::vector<LinePiece>& lines) {
  std::map<std::pair<uint32_t, uint32_t>, std::vector<size_t>> faces_at;
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (size_t i = 0; i < 3; ++i) {
      faces_at[std::minmax(mesh.triangles[f][i], mesh.triangles[f][(i + 1) % 3])].push_back(f);
    }
  }
  std::vector<std::pair<uint32_t, uint32_t>> sharp;
  for (const auto& [edge, faces] : faces_at) {
    const bool smooth =
        faces.size() == 2 && cosine(mesh.area_normals[faces[0]], mesh.area_normals[faces[1]]) >= min_cosine;
    if (smooth) continue;
    const Vector3d to_viewer = viewpoint - mesh.vertices[edge.first];
    const auto faces_viewer = [&](size_t f) { return mesh.area_normals[f].dot(to_viewer) > 0; };
    if (faces.size() == 2 && faces_viewer(faces[0]) != faces_viewer(faces[1])) {
      // Part of the contour, however short; add_contour() does not see it, it never looks across a crease.
      lines.push_back({mesh.vertices[edge.first], mesh.vertices[edge.second]});
    } else {
      sharp.push_back(edge);
    }
  }
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  add_long_lines(mesh, sharp, 0.15 * box.sizes().norm(), lines);
}

void add_contour(const Welded& mesh, const Vector3d& viewpoint, double min_cosine,
                 std::vector<LinePiece>& lines) {
  std::vector<std::vector<size_t>> faces_at(mesh.vertices.size());
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (const uint32_t corner : mesh.triangles[f]) faces_at[corner].push_back(f);
  }
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    std::array<double, 3> facing;  // > 0: the corner's normal points to the viewpoint
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t corner = mesh.triangles[f][i];
      Vector3d normal = Vector3d::Zero();
      for (const size_t other : faces_at[corner]) {  // not across creases
        if (cosine(mesh.area_normals[f], mesh.area_normals[other]) >= min_cosine) {
          normal += mesh.area_normals[other];
        }
      }
      facing[i] = normal.dot(viewpoint - mesh.vertices[corner]);
    }
    std::array<Vector3d, 3> crossing;
    size_t crossings = 0;
    for (size_t i = 0; i < 3; ++i) {
      const size_t j = (i + 1) % 3;
      if ((facing[i] > 0) == (facing[j] > 0)) continue;
      const Vector3d &a = mesh.vertices[mesh.triangles[f][i]], &b = mesh.vertices[mesh.triangles[f][j]];
      crossing[crossings++] = a + facing[i] / (facing[i] - facing[j]) * (b - a);
    }
    if (crossings == 2) lines.push_back({crossing[0], crossing[1]});
  }
}

}  // namespace

std::vector<LinePiece> model_lines(const Mesh& mesh, const Vector3d& viewpoint, double crease_angle) {
  const Welded welded = weld(mesh);
  const double min_cosine = std::cos(crease_angle);
  std::vector<LinePiece> lines;
  add_creases(welded, viewpoint, min_cosine, lines);
  add_contour(welded, viewpoint, min_cosine, lines);
  return lines;
}

}  // namespace edgepose::internal
