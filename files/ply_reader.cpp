#include "files/mesh_parsers.h"
#include "files/ply_body.h"

namespace edgepose {
namespace {

template <typename Body>
void read_vertices(Body& body, const PlyElement& element, double scale, Mesh& mesh) {
  constexpr const char* kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  std::vector<int> role(element.properties.size(), -1);  // index into kNames
  bool found[6];
  for (int i = 0; i < 6; ++i) {
    const int property = element.find(kNames[i]);
    found[i] = property >= 0 && !element.properties[property].is_list;
    if (found[i]) role[property] = i;
  }
  if (!found[0] || !found[1] || !found[2])
    body.fail("vertices with properties x, y and z", "not all of them");
  const bool has_normals = found[3] && found[4] && found[5];
  mesh.vertices.reserve(element.count);
  if (has_normals) mesh.normals.reserve(element.count);
  for (uint64_t i = 0; i < element.count; ++i) {
    double value[6] = {};
    for (size_t p = 0; p < role.size(); ++p) {
      if (role[p] >= 0) {
        value[role[p]] = body.value(element.properties[p].type);
      } else {
        skip_property(body, element.properties[p]);
      }
    }
    mesh.vertices.emplace_back((Eigen::Vector3d(value[0], value[1], value[2]) * scale).cast<float>());
    if (has_normals) mesh.normals.emplace_back(Eigen::Vector3d(value[3], value[4], value[5]).cast<float>());
  }
}

template <typename Body>
uint32_t read_index(Body& body, ScalarType type, size_t vertices) {
  return static_cast<uint32_t>(
      read_whole_number(body, type, static_cast<double>(vertices - 1), "a vertex index"));
}

/// A polygon, cut into a fan. Fewer than three corners make no triangle.
template <typename Body>
void read_polygon(Body& body, const PlyProperty& list, size_t vertices, Mesh& mesh) {
  const size_t corners = read_list_length(body, list);
  uint32_t first = 0, previous = 0;
  for (size_t i = 0; i < corners; ++i) {
    const uint32_t index = read_index(body, list.type, vertices);
    if (i == 0) first = index;
    if (i >= 2) mesh.triangles.push_back({first, previous, index});
    previous = index;
  }
}

/// Triangle strips, as in older scans: every other triangle is turned, -1 starts a new strip.
template <typename Body>
void read_strips(Body& body, const PlyProperty& list, size_t vertices, Mesh& mesh) {
  const size_t length = read_list_length(body, list);
  uint32_t a = 0, b = 0;
  size_t in_strip = 0;
  for (size_t i = 0; i < length; ++i) {
    const double index = body.value(list.type);
    if (index == -1) {
      in_strip = 0;
      continue;
    }
    if (!(index >= 0 && index < static_cast<double>(vertices))) {
      body.fail("a vertex index from 0 to " + std::to_string(vertices - 1) + ", or -1",
                number_text(index, 12));
    }
    const auto c = static_cast<uint32_t>(index);
    if (in_strip >= 2)
      mesh.triangles.push_back(in_strip % 2 == 0 ? std::array{a, b, c} : std::array{b, a, c});
    a = b;
    b = c;
    ++in_strip;
  }
}

template <typename Body>
void read_faces(Body& body, const PlyElement& element, size_t vertices, Mesh& mesh) {
  int list = element.find("vertex_indices");
  if (list < 0) list = element.find("vertex_index");
  if (list < 0 || !element.properties[list].is_list || !is_integer(element.properties[list].type)) {
    body.fail("faces with a list of integers 'vertex_indices'", "none");
  }
  for (uint64_t i = 0; i < element.count; ++i) {
    for (size_t p = 0; p < element.properties.size(); ++p) {
      if (static_cast<int>(p) != list) {
        skip_property(body, element.properties[p]);
      } else if (element.name == "tristrips") {
        read_strips(body, element.properties[p], vertices, mesh);
      } else {
        read_polygon(body, element.properties[p], vertices, mesh);
      }
    }
  }
}

template <typename Body>
ParsedMesh read_body(Body body, const PlyHeader& header, double scale) {
  const PlyElement* vertex = header.find("vertex");
  if (!vertex || vertex->count == 0) body.fail("a PLY file with vertices", "none");
  if (vertex->count > kMostVertices) body.fail("fewer vertices", std::to_string(vertex->count));
  ParsedMesh result;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(body, element, scale, result.cloud);
    } else if (element.name == "face" || element.name == "tristrips") {
      result.expects_faces = true;
      read_faces(body, element, vertex->count, result.cloud);
    } else if (!element.properties.empty()) {
      for (uint64_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) skip_property(body, property);
      }
    }
  }
  body.finish();
  return result;
}

}  // namespace

ParsedMesh parse_ply(std::span<const std::byte> bytes, const std::string& name, double scale) {
  const PlyHeader header = parse_ply_header(bytes, name);
  if (header.format == PlyHeader::Format::kAscii) {
    TextCursor cursor(bytes, name);
    cursor.skip_to(header.size);
    return read_body(PlyTextBody(std::move(cursor)), header, scale);
  }
  const bool big = header.format == PlyHeader::Format::kBigEndian;
  const bool swap_bytes = big != (std::endian::native == std::endian::big);
  return read_body(PlyBinaryBody(bytes.subspan(header.size), name, swap_bytes), header, scale);
}

}  // namespace edgepose
