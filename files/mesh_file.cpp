#include "files/mesh_file.h"

#include <algorithm>

#include "common/error.h"
#include "files/mesh_format.h"
#include "files/mesh_parsers.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr size_t kMostBytes = size_t{2} << 30;  // bounds the memory; real meshes have a hundredth of it

/// The format to parse: what the content says, or else the name, so that damaged files get a precise
/// complaint.
MeshFormat choose_format(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.empty()) throw InputError::at(name, "a mesh or cloud (PLY, STL, OBJ, PCD)", "an empty file");
  const MeshFormat named = format_of_name(name);
  const MeshFormat found = format_of_content(bytes);
  if (found == MeshFormat::kUnknown && named == MeshFormat::kUnknown) {
    throw InputError::at(name, "a mesh or cloud (PLY, STL, OBJ, PCD)", describe_content(bytes));
  }
  if (found == MeshFormat::kUnknown) return named;
  if (named != MeshFormat::kUnknown && named != found) {
    throw InputError::at(name, name_of(named) + " format, as the name says", name_of(found) + " format",
                         "correct the file's extension or give the right file");
  }
  return found;
}

ParsedMesh parse(std::span<const std::byte> bytes, const std::string& name, LengthUnit unit) {
  const double scale = metres_per(unit);
  ParsedMesh result;
  switch (choose_format(bytes, name)) {
    case MeshFormat::kPly:
      result = parse_ply(bytes, name, scale);
      break;
    case MeshFormat::kStl:
      result = parse_stl(bytes, name, scale);
      break;
    case MeshFormat::kObj:
      result = parse_obj(bytes, name, scale);
      break;
    case MeshFormat::kPcd:
      result = parse_pcd(bytes, name, scale);
      break;
    case MeshFormat::kUnknown:
      break;
  }
  if (result.cloud.vertices.empty()) throw InputError::at(name, "a mesh or cloud with vertices", "none");
  return result;
}

void drop_non_finite_points(Cloud& cloud, const std::string& name) {
  size_t kept = 0;
  for (size_t i = 0; i < cloud.vertices.size(); ++i) {
    if (!cloud.vertices[i].allFinite()) continue;
    cloud.vertices[kept] = cloud.vertices[i];
    if (!cloud.normals.empty()) cloud.normals[kept] = cloud.normals[i];
    ++kept;
  }
  if (kept == 0) throw InputError::at(name, "a cloud with finite points", "only NaN or infinite ones");
  cloud.vertices.resize(kept);
  if (!cloud.normals.empty()) cloud.normals.resize(kept);
}

}  // namespace

Mesh parse_mesh(std::span<const std::byte> bytes, const std::string& name, LengthUnit unit) {
  ParsedMesh parsed = parse(bytes, name, unit);
  if (parsed.cloud.triangles.empty()) {
    // Some programs declare an empty list of faces in a cloud; without normals it is rather a broken mesh.
    if (parsed.expects_faces && parsed.cloud.normals.empty()) {
      throw InputError::at(name, "a mesh with faces, or a cloud with normals",
                           std::to_string(parsed.cloud.vertices.size()) + " vertices and no faces",
                           "export the surface as triangles");
    }
  }
  return std::move(parsed.cloud);
}

Cloud parse_cloud(std::span<const std::byte> bytes, const std::string& name, LengthUnit unit) {
  Cloud cloud = parse(bytes, name, unit).cloud;
  cloud.triangles.clear();
  drop_non_finite_points(cloud, name);
  return cloud;
}

Mesh read_mesh(const std::filesystem::path& path, LengthUnit unit) {
  const std::string bytes = read_whole_file(path, "a mesh or cloud (PLY, STL, OBJ, PCD)", kMostBytes);
  return parse_mesh(std::as_bytes(std::span(bytes)), path.string(), unit);
}

Cloud read_cloud(const std::filesystem::path& path, LengthUnit unit) {
  const std::string bytes = read_whole_file(path, "a cloud (PLY, PCD)", kMostBytes);
  return parse_cloud(std::as_bytes(std::span(bytes)), path.string(), unit);
}

}  // namespace edgepose
