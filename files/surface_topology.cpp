#include "files/surface_topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <tuple>

#include "files/vertex_weld.h"

namespace edgepose {
namespace {

/// Twice the area over the square of the longest side below which float coordinates say nothing about a
/// normal.
constexpr double kNeedle = 1e-6;
constexpr uint32_t kNobody = std::numeric_limits<uint32_t>::max();

using Triangle = std::array<uint32_t, 3>;

std::array<Eigen::Vector3d, 3> corners(const std::vector<Eigen::Vector3f>& places, const Triangle& triangle) {
  return {places[triangle[0]].cast<double>(), places[triangle[1]].cast<double>(),
          places[triangle[2]].cast<double>()};
}

double double_area(const std::array<Eigen::Vector3d, 3>& p) {
  return (p[1] - p[0]).cross(p[2] - p[0]).norm();
}

bool is_needle(const std::array<Eigen::Vector3d, 3>& p) {
  const double longest =
      std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
  return !(double_area(p) > kNeedle * longest);
}

/// Classifies each triangle; those that make up the surface go to `topology.triangles`.
void collect_triangles(const Mesh& mesh, SurfaceTopology& topology) {
  VertexWeld weld;
  std::vector<uint32_t> place(mesh.vertices.size(), kNobody);  // kNobody: not finite
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].allFinite()) place[i] = weld.add(mesh.vertices[i]);
  }
  topology.places = weld.take();
  topology.state.assign(mesh.triangles.size(), TriangleState::kUsable);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle triangle = mesh.triangles[t];
    TriangleState& state = topology.state[t];
    for (uint32_t& corner : triangle) {
      if (corner >= place.size()) {
        state = TriangleState::kBadIndex;
        break;
      }
      corner = place[corner];
      if (corner == kNobody) state = TriangleState::kNonFinite;
    }
    if (state != TriangleState::kUsable) continue;
    const bool collapsed =
        triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (collapsed || is_needle(corners(topology.places, triangle))) state = TriangleState::kDegenerate;
    if (collapsed) continue;
    topology.triangles.push_back(triangle);
    topology.source.push_back(static_cast<uint32_t>(t));
  }
}

/// Keeps the first of several triangles with the same corners in the same order of rotation.
void drop_duplicates(SurfaceTopology& topology) {
  struct Entry {
    Triangle key;
    uint32_t index;
    bool operator<(const Entry& other) const {
      return std::tie(key, index) < std::tie(other.key, other.index);
    }
  };
  std::vector<Entry> entries(topology.triangles.size());
  for (size_t i = 0; i < entries.size(); ++i) {
    entries[i] = {topology.triangles[i], static_cast<uint32_t>(i)};
    Triangle& key = entries[i].key;
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
  }
  std::sort(entries.begin(), entries.end());
  std::vector<bool> drop(entries.size(), false);
  for (size_t i = 1; i < entries.size(); ++i) {
    if (entries[i].key == entries[i - 1].key) drop[entries[i].index] = true;
  }
  size_t kept = 0;
  for (size_t i = 0; i < drop.size(); ++i) {
    if (drop[i]) {
      TriangleState& state = topology.state[topology.source[i]];
      if (state == TriangleState::kUsable) state = TriangleState::kDuplicate;
      continue;
    }
    topology.triangles[kept] = topology.triangles[i];
    topology.source[kept++] = topology.source[i];
  }
  topology.triangles.resize(kept);
  topology.source.resize(kept);
}

/// One side of an edge: the triangle that has it, and which of its three it is.
struct HalfEdge {
  uint64_t key;  // smaller place << 32 | larger place
  uint32_t triangle;
  uint8_t side;
  bool forward;  // from the smaller to the larger place
  bool operator<(const HalfEdge& other) const {
    return std::tie(key, triangle) < std::tie(other.key, other.triangle);
  }
};

struct Neighbour {
  uint32_t triangle = kNobody;
  bool disagrees = false;  // about which side is outside
};
using Neighbours = std::vector<std::array<Neighbour, 3>>;

std::vector<HalfEdge> sorted_half_edges(const std::vector<Triangle>& triangles) {
  std::vector<HalfEdge> result;
  result.reserve(3 * triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (uint8_t side = 0; side < 3; ++side) {
      const uint32_t a = triangles[t][side], b = triangles[t][(side + 1) % 3];
      result.push_back(
          {uint64_t{std::min(a, b)} << 32 | std::max(a, b), static_cast<uint32_t>(t), side, a < b});
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Counts edges by kind and links triangles across edges that have just two. `open` marks triangles with
/// others.
Neighbours link_neighbours(SurfaceTopology& topology, std::vector<bool>& open) {
  Neighbours neighbours(topology.triangles.size());
  open.assign(topology.triangles.size(), false);
  const std::vector<HalfEdge> sides = sorted_half_edges(topology.triangles);
  for (size_t begin = 0, end; begin < sides.size(); begin = end) {
    for (end = begin + 1; end < sides.size() && sides[end].key == sides[begin].key;) ++end;
    ++topology.edges;
    if (end - begin != 2) {
      ++(end - begin == 1 ? topology.open_edges : topology.non_manifold_edges);
      for (size_t i = begin; i < end; ++i) open[sides[i].triangle] = true;
      continue;
    }
    const HalfEdge &a = sides[begin], &b = sides[begin + 1];
    const bool disagrees = a.forward == b.forward;
    topology.inconsistent_edges += disagrees;
    neighbours[a.triangle][a.side] = {b.triangle, disagrees};
    neighbours[b.triangle][b.side] = {a.triangle, disagrees};
  }
  return neighbours;
}

/// Follows one part from `seed` and decides for each of its triangles whether to turn it.
void walk_part(uint32_t seed, const Neighbours& neighbours, const std::vector<bool>& open,
               const Eigen::Vector3d& centre, SurfaceTopology& topology) {
  const auto number = static_cast<uint32_t>(topology.parts.size());
  SurfaceTopology::Part part;
  std::vector<uint32_t> members = {seed};
  topology.part[seed] = number;
  double area_kept = 0, area_turned = 0;
  for (size_t i = 0; i < members.size(); ++i) {
    const uint32_t t = members[i];
    const auto p = corners(topology.places, topology.triangles[t]);
    (topology.turn[t] ? area_turned : area_kept) += double_area(p);
    const double volume = (p[0] - centre).dot((p[1] - centre).cross(p[2] - centre)) / 6;
    part.signed_volume += topology.turn[t] ? -volume : volume;
    part.turned += topology.turn[t];
    if (open[t]) part.closed = false;
    for (const Neighbour& next : neighbours[t]) {
      if (next.triangle == kNobody) continue;
      const bool turn = topology.turn[t] != next.disagrees;
      if (topology.part[next.triangle] == kNobody) {
        topology.part[next.triangle] = number;
        topology.turn[next.triangle] = turn;
        members.push_back(next.triangle);
      } else if (topology.turn[next.triangle] != turn) {
        part.orientable = false;
      }
    }
  }
  if (area_turned > area_kept) {
    for (const uint32_t t : members) topology.turn[t] = !topology.turn[t];
    part.signed_volume = -part.signed_volume;
    part.turned = members.size() - part.turned;
  }
  topology.parts.push_back(part);
}

}  // namespace

SurfaceTopology find_topology(const Mesh& mesh) {
  SurfaceTopology topology;
  collect_triangles(mesh, topology);
  drop_duplicates(topology);
  std::vector<bool> open;
  const Neighbours neighbours = link_neighbours(topology, open);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& place : topology.places) centre += place.cast<double>();
  if (!topology.places.empty()) centre /= static_cast<double>(topology.places.size());
  topology.part.assign(topology.triangles.size(), kNobody);
  topology.turn.assign(topology.triangles.size(), false);
  for (size_t t = 0; t < topology.triangles.size(); ++t) {
    if (topology.part[t] == kNobody) walk_part(static_cast<uint32_t>(t), neighbours, open, centre, topology);
  }
  return topology;
}

}  // namespace edgepose
