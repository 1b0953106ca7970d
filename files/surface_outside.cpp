#include "files/surface_outside.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "files/surface_views.h"

namespace edgepose {
namespace {

/// An open hemisphere shows its hollow side in 1/3 of the pixels, a flat sheet in 1/2.
constexpr double kClearlyBack = 0.6;
constexpr size_t kFewestPixels = 20;

struct PartSums {
  double area = 0;
  double agreement = 0;  ///< of the vertex normals with the triangles, weighed by area; 0 without normals
};

std::vector<PartSums> sum_up(const Mesh& mesh, const SurfaceTopology& topology) {
  std::vector<PartSums> sums(topology.parts.size());
  const bool has_normals = mesh.normals.size() == mesh.vertices.size();
  for (size_t t = 0; t < topology.triangles.size(); ++t) {
    const auto& [a, b, c] = topology.triangles[t];
    const Eigen::Vector3d origin = topology.places[a].cast<double>();
    Eigen::Vector3d area_normal =
        0.5 * (topology.places[b].cast<double>() - origin).cross(topology.places[c].cast<double>() - origin);
    if (topology.turn[t]) area_normal = -area_normal;
    PartSums& part = sums[topology.part[t]];
    part.area += area_normal.norm();
    if (!has_normals) continue;
    for (const uint32_t vertex : mesh.triangles[topology.source[t]]) {
      const Eigen::Vector3d normal = mesh.normals[vertex].cast<double>();
      if (normal.allFinite() && normal.squaredNorm() > 0)
        part.agreement += area_normal.dot(normal.normalized()) / 3;
    }
  }
  return sums;
}

enum class Verdict { kOutwards, kInverted, kUndecided };

Verdict judge(const SurfaceTopology::Part& part, const SeenSides& seen, const PartSums& sums) {
  if (part.closed) return seen.back > seen.front ? Verdict::kInverted : Verdict::kOutwards;
  if (seen.total() < kFewestPixels) return Verdict::kOutwards;
  if (seen.back_share() > kClearlyBack) return Verdict::kInverted;
  if (seen.back_share() < 1 - kClearlyBack) return Verdict::kOutwards;
  constexpr double kMostNormals = 0.5;  // three quarters of the area one way
  if (sums.agreement < -kMostNormals * sums.area) return Verdict::kInverted;
  if (sums.agreement > kMostNormals * sums.area) return Verdict::kOutwards;
  return Verdict::kUndecided;
}

}  // namespace

OutsideVerdict find_outside(const Mesh& mesh, const SurfaceTopology& topology) {
  OutsideVerdict result;
  result.part_inverted.assign(topology.parts.size(), false);
  const auto plainly_sound = [](const auto& part) { return part.closed && part.signed_volume > 0; };
  if (std::all_of(topology.parts.begin(), topology.parts.end(), plainly_sound)) return result;
  if (topology.parts.size() == 1 && topology.parts[0].closed && topology.parts[0].signed_volume < 0) {
    result.part_inverted[0] = true;
    result.inverted = 1;
    result.inverted_area_share = 1;
    return result;
  }
  const std::vector<SeenSides> seen = look_from_around(topology);
  const std::vector<PartSums> sums = sum_up(mesh, topology);
  double area = 0, inverted_area = 0;
  for (size_t i = 0; i < topology.parts.size(); ++i) {
    const Verdict verdict = judge(topology.parts[i], seen[i], sums[i]);
    area += sums[i].area;
    result.undecided += verdict == Verdict::kUndecided;
    if (verdict != Verdict::kInverted) continue;
    result.part_inverted[i] = true;
    ++result.inverted;
    inverted_area += sums[i].area;
  }
  if (area > 0) result.inverted_area_share = inverted_area / area;
  return result;
}

}  // namespace edgepose
