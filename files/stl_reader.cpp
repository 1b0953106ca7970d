#include "common/error.h"
#include "files/mesh_format.h"
#include "files/mesh_parsers.h"
#include "files/scalar_type.h"
#include "files/text_cursor.h"
#include "files/vertex_weld.h"

namespace edgepose {
namespace {

constexpr size_t kHeaderSize = 84, kTriangleSize = 50;

/// Collects corners. The facet normals of the file are not used: the order of the corners says the same.
class StlTriangles {
 public:
  explicit StlTriangles(double scale) : scale_(scale) {}
  void add_corner(const Eigen::Vector3d& corner) {
    triangle_[corner_++] = weld_.add((corner * scale_).cast<float>());
    if (corner_ < 3) return;
    triangles_.push_back(triangle_);
    corner_ = 0;
  }
  ParsedMesh take() {
    ParsedMesh result;
    result.cloud.vertices = weld_.take();
    result.cloud.triangles = std::move(triangles_);
    result.expects_faces = true;
    return result;
  }

 private:
  double scale_;
  VertexWeld weld_;
  std::array<uint32_t, 3> triangle_{};
  size_t corner_ = 0;
  std::vector<std::array<uint32_t, 3>> triangles_;
};

ParsedMesh parse_binary(std::span<const std::byte> bytes, const std::string& name, double scale) {
  if (bytes.size() < kHeaderSize) {
    throw InputError::at(name, "an STL file ('solid ...' or a binary header of 84 bytes)",
                         std::to_string(bytes.size()) + " bytes (" + describe_content(bytes) + ")",
                         "the file is cut short, damaged or no STL");
  }
  const auto count = static_cast<uint64_t>(load_scalar(bytes.data() + 80, ScalarType::kUint32, false));
  const uint64_t size = kHeaderSize + count * kTriangleSize;
  if (size != bytes.size()) {
    throw InputError::at(name,
                         "a binary STL file of " + std::to_string(size) + " bytes, as its header announces " +
                             std::to_string(count) + " triangles",
                         std::to_string(bytes.size()) + " bytes (" + describe_content(bytes) + ")",
                         "the file is cut short, damaged or no STL");
  }
  StlTriangles triangles(scale);
  for (size_t at = kHeaderSize; at < bytes.size(); at += kTriangleSize) {
    for (size_t corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d vertex;
      for (size_t axis = 0; axis < 3; ++axis) {  // three floats of the facet normal come first
        const size_t value = 3 + 3 * corner + axis;
        vertex[axis] = load_scalar(bytes.data() + at + 4 * value, ScalarType::kFloat32, false);
      }
      triangles.add_corner(vertex);
    }
  }
  return triangles.take();
}

void expect(TextCursor& cursor, const char* word) {
  const std::string_view token = cursor.token();
  if (lower_case(token) != word) cursor.fail_at_token("'" + std::string(word) + "'", token);
}

Eigen::Vector3d read_vector(TextCursor& cursor, const char* what) {
  const double x = cursor.number(what), y = cursor.number(what), z = cursor.number(what);
  return {x, y, z};
}

void read_facet(TextCursor& cursor, StlTriangles& triangles) {
  expect(cursor, "normal");
  // Some programs write "nan" or worse for the normal of a thin triangle; nobody needs it.
  for (int i = 0; i < 3; ++i) cursor.token();
  expect(cursor, "outer");
  expect(cursor, "loop");
  for (int corner = 0; corner < 3; ++corner) {
    expect(cursor, "vertex");
    triangles.add_corner(read_vector(cursor, "coordinate"));
  }
  expect(cursor, "endloop");
  expect(cursor, "endfacet");
}

/// One or more solids after each other.
ParsedMesh parse_text(std::span<const std::byte> bytes, const std::string& name, double scale) {
  TextCursor cursor(bytes, name);
  StlTriangles triangles(scale);
  for (;;) {
    const std::string_view solid = cursor.token();
    if (solid.empty()) break;
    if (lower_case(solid) != "solid") cursor.fail_at_token("'solid' or the end of the file", solid);
    cursor.line();  // the name
    for (;;) {
      const std::string_view token = cursor.token();
      const std::string word = lower_case(token);
      if (word == "endsolid") break;
      if (word != "facet") cursor.fail_at_token("'facet' or 'endsolid'", token);
      read_facet(cursor, triangles);
    }
    cursor.line();  // the name again
  }
  return triangles.take();
}

}  // namespace

ParsedMesh parse_stl(std::span<const std::byte> bytes, const std::string& name, double scale) {
  if (starts_as_text_stl(bytes)) return parse_text(bytes, name, scale);
  return parse_binary(bytes, name, scale);
}

}  // namespace edgepose
