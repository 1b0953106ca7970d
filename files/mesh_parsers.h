#pragma once
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "files/mesh_file.h"

namespace edgepose {

/// What a parser makes of a file, before the common checks of parse_mesh() and parse_cloud().
struct ParsedMesh {
  Cloud cloud;
  bool expects_faces = false;  ///< the file means to be a mesh: a format for meshes, or it declares faces
};

/// One parser a format. `scale` [m per unit of the file] is applied to vertices. Each bounds every count by
/// the bytes that remain before it allocates. They throw InputError that starts with `name`.
ParsedMesh parse_ply(std::span<const std::byte> bytes, const std::string& name, double scale);
ParsedMesh parse_stl(std::span<const std::byte> bytes, const std::string& name, double scale);
ParsedMesh parse_obj(std::span<const std::byte> bytes, const std::string& name, double scale);
ParsedMesh parse_pcd(std::span<const std::byte> bytes, const std::string& name, double scale);

/// Triangles store 32-bit indices; no file may have more vertices.
constexpr size_t kMostVertices = std::numeric_limits<uint32_t>::max();

}  // namespace edgepose
