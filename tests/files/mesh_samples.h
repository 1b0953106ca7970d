#pragma once
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <string>

#include "files/mesh_file.h"

namespace edgepose {

inline Mesh parse_text(const std::string& content, const std::string& name,
                       LengthUnit unit = LengthUnit::kMetre) {
  return parse_mesh(std::as_bytes(std::span(content)), name, unit);
}

/// The bytes of numbers, one after another, as this (little-endian) machine has them.
template <typename... Numbers>
std::string bytes_of(Numbers... numbers) {
  std::string result;
  (result.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return result;
}

/// The same in the other byte order.
template <typename... Numbers>
std::string swapped_bytes_of(Numbers... numbers) {
  std::string result;
  const auto add = [&](auto number) {
    const std::string bytes = bytes_of(number);
    result.append(bytes.rbegin(), bytes.rend());
  };
  (add(numbers), ...);
  return result;
}

/// Corners (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1) times `size` [m]; closed, facing outwards.
inline Mesh tetrahedron(float size = 0.1f) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// A ball of `radius` [m] with normals, made of rings from pole to pole; `rings` fewer make it open at the
/// bottom.
inline Mesh ball(float radius, int rings = 16, int leave_out = 0, int sectors = 24) {
  Mesh mesh;
  for (int ring = 0; ring <= rings - leave_out; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int sector = 0; sector < sectors; ++sector) {
      const double azimuth = 2 * std::numbers::pi * sector / sectors;
      const bool pole = ring == 0 || ring == rings;
      const Eigen::Vector3d normal(pole ? 0 : std::sin(polar) * std::cos(azimuth),
                                   pole ? 0 : std::sin(polar) * std::sin(azimuth),
                                   pole ? (ring == 0 ? 1 : -1) : std::cos(polar));
      mesh.normals.push_back(normal.cast<float>());
      mesh.vertices.push_back(radius * mesh.normals.back());
    }
  }
  const auto at = [&](int ring, int sector) {
    return static_cast<uint32_t>(ring * sectors + sector % sectors);
  };
  for (int ring = 0; ring < rings - leave_out; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      if (ring != 0) mesh.triangles.push_back({at(ring, sector), at(ring + 1, sector), at(ring, sector + 1)});
      if (ring != rings - 1) {
        mesh.triangles.push_back({at(ring, sector + 1), at(ring + 1, sector), at(ring + 1, sector + 1)});
      }
    }
  }
  return mesh;
}

/// Adds `other`, moved by `offset`.
inline void append(Mesh& mesh, const Mesh& other, const Eigen::Vector3f& offset) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : other.vertices) mesh.vertices.push_back(vertex + offset);
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

inline void turn_inside_out(Mesh& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
}

inline double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].cast<double>().dot(
                  mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>())) /
              6;
  }
  return volume;
}

}  // namespace edgepose
