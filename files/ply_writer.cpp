#include <bit>
#include <cstring>
#include <stdexcept>

#include "common/atomic_file.h"
#include "files/mesh_file.h"

namespace edgepose {
namespace {

static_assert(std::endian::native == std::endian::little, "write_ply() copies numbers as they are in memory");

template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, const Eigen::Vector3f& vector) {
  for (const float value : vector) append(bytes, value);
}

void check(const Mesh& mesh) {
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) {
    throw std::invalid_argument("write_ply: normals must be one per vertex");
  }
  for (const auto& triangle : mesh.triangles) {
    for (const uint32_t vertex : triangle) {
      if (vertex >= mesh.vertices.size())
        throw std::invalid_argument("write_ply: triangle without its vertex");
    }
  }
}

std::string header(const Mesh& mesh, LengthUnit unit) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment unit: ";
  text += unit == LengthUnit::kMillimetre ? "millimetre" : "metre";
  text += "\nelement vertex " + std::to_string(mesh.vertices.size()) +
          "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.triangles.empty()) {
    text += "element face " + std::to_string(mesh.triangles.size()) +
            "\nproperty list uchar int vertex_indices\n";
  }
  return text + "end_header\n";
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Mesh& mesh, LengthUnit unit) {
  check(mesh);
  std::string bytes = header(mesh, unit);
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    append(bytes, Eigen::Vector3f((mesh.vertices[i].cast<double>() / metres_per(unit)).cast<float>()));
    if (!mesh.normals.empty()) append(bytes, mesh.normals[i]);
  }
  for (const auto& triangle : mesh.triangles) {
    append(bytes, uint8_t{3});
    append(bytes, triangle);
  }
  write_file_atomically(path, bytes);
}

}  // namespace edgepose
