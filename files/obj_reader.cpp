#include <limits>
#include <optional>

#include "common/error.h"
#include "files/mesh_parsers.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr int64_t kMostIndex = kNone;

struct Corner {
  uint32_t vertex = 0;
  uint32_t normal = kNone;
};

class ObjReader {
 public:
  ObjReader(std::span<const std::byte> bytes, const std::string& name, double scale)
      : cursor_(bytes, name), scale_(scale) {}

  ParsedMesh read() {
    while (!cursor_.at_end()) {
      const std::string_view line = cursor_.line();
      read_line(line.ends_with('\\') ? continued(line) : line);
    }
    check_indices();
    ParsedMesh result;
    result.cloud.normals = vertex_normals();
    result.cloud.vertices = std::move(vertices_);
    result.cloud.triangles = std::move(triangles_);
    result.expects_faces = true;
    return result;
  }

 private:
  /// A line that ends with a backslash goes on in the next one.
  std::string_view continued(std::string_view line) {
    joined_ = line;
    while (joined_.ends_with('\\') && !cursor_.at_end()) {
      joined_.back() = ' ';
      joined_ += cursor_.line();
    }
    return joined_;
  }

  void read_line(std::string_view line) {
    const std::string_view keyword = next_token(line);
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "v") {
      vertices_.emplace_back((read_vector(line) * scale_).cast<float>());
    } else if (keyword == "vn") {
      normals_.emplace_back(read_vector(line).cast<float>());
    } else if (keyword == "f" || keyword == "fo") {
      read_face(line);
    } else if (keyword.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") !=
               std::string_view::npos) {
      cursor_.fail("a line of an OBJ file (v, vn, vt, f, o, g, usemtl, ...)", quoted(keyword));
    }  // else: names, materials, texture coordinates, lines, curves: nothing that we need
  }

  Eigen::Vector3d read_vector(std::string_view line) const {
    Eigen::Vector3d vector;
    for (double& value : vector) {
      const std::string_view token = next_token(line);
      const std::optional<double> number = parse_number(token);
      if (!number) cursor_.fail("three numbers", token.empty() ? "the end of the line" : quoted(token));
      value = *number;
    }
    return vector;  // a weight or colours may follow
  }

  void read_face(std::string_view line) {
    size_t corners = 0;
    Corner first, previous;
    for (std::string_view token = next_token(line); !token.empty(); token = next_token(line)) {
      if (token[0] == '#') break;
      const Corner corner = read_corner(token);
      if (corners == 0) first = corner;
      if (corners >= 2) add_triangle(first, previous, corner);
      previous = corner;
      ++corners;
    }
    if (corners < 3) cursor_.fail("a face with at least three corners", std::to_string(corners));
  }

  /// v, v/t, v//n or v/t/n.
  Corner read_corner(std::string_view token) const {
    std::string_view part[3];
    for (size_t i = 0, begin = 0; i < 3 && begin <= token.size(); ++i) {
      const size_t end = i == 2 ? token.size() : std::min(token.find('/', begin), token.size());
      part[i] = token.substr(begin, end - begin);
      begin = end + 1;
    }
    Corner corner;
    corner.vertex = read_index(part[0], vertices_.size(), token);
    if (!part[1].empty() && !parse_integer(part[1])) fail_corner(token);
    if (!part[2].empty()) corner.normal = read_index(part[2], normals_.size(), token);
    return corner;
  }

  /// Counted from 1, or backwards from the latest one with a minus. What comes later in the file may be
  /// named, so the upper end is checked when all is read.
  uint32_t read_index(std::string_view text, size_t count, std::string_view token) const {
    const std::optional<int64_t> index = parse_integer(text);
    if (!index || *index == 0 || *index > kMostIndex || *index < -kMostIndex) fail_corner(token);
    if (*index > 0) return static_cast<uint32_t>(*index - 1);
    const auto back = static_cast<size_t>(-*index);
    if (back > count) fail_corner(token);
    return static_cast<uint32_t>(count - back);
  }

  [[noreturn]] void fail_corner(std::string_view token) const {
    cursor_.fail("a corner v, v/t, v//n or v/t/n with valid indices (counted from 1)", quoted(token));
  }

  void add_triangle(const Corner& a, const Corner& b, const Corner& c) {
    triangles_.push_back({a.vertex, b.vertex, c.vertex});
    triangle_normals_.push_back({a.normal, b.normal, c.normal});
  }

  void check_indices() const {
    for (const auto& triangle : triangles_) {
      for (const uint32_t vertex : triangle) {
        if (vertex >= vertices_.size()) fail_range("vertex", "vertices", vertices_.size(), vertex);
      }
    }
    for (const auto& triangle : triangle_normals_) {
      for (const uint32_t normal : triangle) {
        if (normal != kNone && normal >= normals_.size())
          fail_range("normal", "normals", normals_.size(), normal);
      }
    }
  }

  [[noreturn]] void fail_range(const std::string& what, const std::string& plural, size_t count,
                               uint32_t index) const {
    throw InputError::at(cursor_.name(), "faces that name one of the " + std::to_string(count) + " " + plural,
                         what + " " + std::to_string(uint64_t{index} + 1),
                         "the file is cut short or damaged");
  }

  /// One normal a vertex, or none at all: where faces give a vertex several normals, it lies on a sharp edge
  /// and the faces themselves say it better.
  std::vector<Eigen::Vector3f> vertex_normals() const {
    std::vector<Eigen::Vector3f> result(vertices_.size(), Eigen::Vector3f::Zero());
    std::vector<uint32_t> normal_of(vertices_.size(), kNone);
    for (size_t t = 0; t < triangles_.size(); ++t) {
      for (size_t i = 0; i < 3; ++i) {
        const uint32_t normal = triangle_normals_[t][i];
        uint32_t& known = normal_of[triangles_[t][i]];
        if (normal == kNone) return {};
        if (known != kNone && known != normal && normals_[known] != normals_[normal]) return {};
        known = normal;
        result[triangles_[t][i]] = normals_[normal];
      }
    }
    return triangles_.empty() ? std::vector<Eigen::Vector3f>{} : result;
  }

  TextCursor cursor_;
  double scale_;
  std::string joined_;
  std::vector<Eigen::Vector3f> vertices_, normals_;
  std::vector<std::array<uint32_t, 3>> triangles_, triangle_normals_;
};

}  // namespace

ParsedMesh parse_obj(std::span<const std::byte> bytes, const std::string& name, double scale) {
  return ObjReader(bytes, name, scale).read();
}

}  // namespace edgepose
