#pragma once
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "common/error.h"
#include "files/mesh_file.h"
#include "files/mesh_health.h"

namespace edgepose {

/// Stops the fuzzer (a finding) if `fact` does not hold.
inline void require(bool fact) {
  if (!fact) std::abort();
}

/// What must hold for any mesh that mend_mesh() lets pass.
inline void check_mended(const Mesh& mesh) {
  require(!mesh.vertices.empty());
  require(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) require(vertex.allFinite());
  for (const Eigen::Vector3f& normal : mesh.normals) require(std::abs(normal.norm() - 1) < 1e-3f);
  for (const auto& triangle : mesh.triangles) {
    for (const uint32_t vertex : triangle) require(vertex < mesh.vertices.size());
  }
}

/// Bytes to parser to health: only InputError may come out, in one line.
inline void fuzz_mesh(const uint8_t* data, size_t size, const std::string& name) {
  const auto bytes = std::as_bytes(std::span(data, size));
  const auto one_line = [](const InputError& error) {
    require(std::string(error.what()).find('\n') == std::string::npos);
  };
  try {
    const Mesh mesh = parse_mesh(bytes, name, LengthUnit::kMillimetre);
    require(!mesh.vertices.empty());
    for (const auto& triangle : mesh.triangles) {
      for (const uint32_t vertex : triangle) require(vertex < mesh.vertices.size());
    }
    MeshHealth health = check_mesh(mesh);
    check_mended(mend_mesh(mesh, health, name));
  } catch (const InputError& error) {
    one_line(error);
  }
  try {
    for (const Eigen::Vector3f& point : parse_cloud(bytes, name, LengthUnit::kMetre).vertices) {
      require(point.allFinite());
    }
  } catch (const InputError& error) {
    one_line(error);
  }
}

}  // namespace edgepose
