#include <liblzf/lzf.h>

#include "common/error.h"
#include "files/mesh_parsers.h"
#include "files/pcd_header.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

/// Where in a point the six numbers are that we want: x, y, z and the normal. Field indices.
struct WantedFields {
  int field[6];
  bool has_normals;
};

WantedFields find_fields(const PcdHeader& header, const std::string& name) {
  constexpr const char* kNames[] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  WantedFields wanted;
  for (int i = 0; i < 6; ++i) wanted.field[i] = header.find(kNames[i]);
  if (wanted.field[0] < 0 || wanted.field[1] < 0 || wanted.field[2] < 0) {
    throw InputError::at(name, "PCD fields x, y and z with one value each", "not all of them");
  }
  wanted.has_normals = wanted.field[3] >= 0 && wanted.field[4] >= 0 && wanted.field[5] >= 0;
  return wanted;
}

void check_room(const PcdHeader& header, size_t least_point_size, size_t bytes, const std::string& name) {
  if (header.points <= bytes / least_point_size) return;
  throw InputError::at(name,
                       "at least " + std::to_string(least_point_size) + " bytes for each of the " +
                           std::to_string(header.points) + " points that the PCD header announces",
                       std::to_string(bytes) + " bytes for them",
                       "the file is cut short or its header is wrong");
}

void add_point(const double (&value)[6], const WantedFields& wanted, double scale, Mesh& mesh) {
  mesh.vertices.emplace_back((Eigen::Vector3d(value[0], value[1], value[2]) * scale).cast<float>());
  if (wanted.has_normals)
    mesh.normals.emplace_back(Eigen::Vector3d(value[3], value[4], value[5]).cast<float>());
}

void read_text(TextCursor cursor, const PcdHeader& header, const WantedFields& wanted, double scale,
               Mesh& mesh) {
  size_t values = 0;
  for (const PcdField& field : header.fields) values += field.count;
  check_room(header, 2 * values, cursor.remaining() + 1, cursor.name());
  std::vector<int> role(header.fields.size(), -1);
  for (int i = 0; i < 6; ++i) {
    if (wanted.field[i] >= 0) role[wanted.field[i]] = i;
  }
  for (size_t p = 0; p < header.points; ++p) {
    double value[6] = {};
    for (size_t f = 0; f < header.fields.size(); ++f) {
      if (role[f] >= 0) {
        value[role[f]] = cursor.number("PCD value");
        continue;
      }
      for (size_t i = 0; i < header.fields[f].count; ++i) {
        if (cursor.token().empty()) cursor.fail_at_token("as many points as the PCD header announces", "");
      }
    }
    add_point(value, wanted, scale, mesh);
  }
  const std::string_view token = cursor.token();
  if (!token.empty())
    cursor.fail("the end of the file after all points that the PCD header announces", quoted(token));
}

/// Value i of point p is at first[i] + p * step[i].
struct BinaryLayout {
  const std::byte* first[6] = {};
  size_t step[6] = {};
  ScalarType type[6] = {};
};

BinaryLayout lay_out(const PcdHeader& header, const WantedFields& wanted, const std::byte* data,
                     bool by_field) {
  BinaryLayout layout;
  for (int i = 0; i < 6; ++i) {
    if (wanted.field[i] < 0) continue;
    const PcdField& field = header.fields[wanted.field[i]];
    // Compressed files hold all values of the first field, then all of the second, ...
    layout.first[i] = data + (by_field ? field.offset * header.points : field.offset);
    layout.step[i] = by_field ? field.size() : header.point_size;
    layout.type[i] = field.type;
  }
  return layout;
}

void read_binary(const BinaryLayout& layout, const PcdHeader& header, const WantedFields& wanted,
                 double scale, Mesh& mesh) {
  const int values = wanted.has_normals ? 6 : 3;
  mesh.vertices.reserve(header.points);
  if (wanted.has_normals) mesh.normals.reserve(header.points);
  for (size_t p = 0; p < header.points; ++p) {
    double value[6] = {};
    for (int i = 0; i < values; ++i) {
      value[i] = load_scalar(layout.first[i] + p * layout.step[i], layout.type[i], false);
    }
    add_point(value, wanted, scale, mesh);
  }
}

/// Two sizes, then one LZF block.
std::vector<std::byte> decompress(std::span<const std::byte> body, const PcdHeader& header,
                                  const std::string& name) {
  if (body.size() < 8) throw InputError::at(name, "8 bytes of sizes before compressed PCD data", "fewer");
  const auto packed = static_cast<size_t>(load_scalar(body.data(), ScalarType::kUint32, false));
  const auto unpacked = static_cast<size_t>(load_scalar(body.data() + 4, ScalarType::kUint32, false));
  body = body.subspan(8);
  if (packed > body.size()) {
    throw InputError::at(name, std::to_string(packed) + " bytes of compressed PCD data",
                         std::to_string(body.size()) + " bytes", "the file is cut short or damaged");
  }
  // LZF's best is 264 bytes from 3; anything beyond is a lie that must not make us allocate.
  constexpr size_t kBestRatio = 88;
  if (unpacked != header.points * header.point_size || unpacked / kBestRatio > packed) {
    throw InputError::at(name,
                         std::to_string(header.points) + " points of " + std::to_string(header.point_size) +
                             " bytes in the compressed PCD data",
                         std::to_string(unpacked) + " bytes from " + std::to_string(packed),
                         "the file is damaged");
  }
  std::vector<std::byte> data(unpacked);
  const unsigned size = lzf_decompress(body.data(), static_cast<unsigned>(packed), data.data(),
                                       static_cast<unsigned>(unpacked));
  if (size != unpacked) throw InputError::at(name, "sound LZF data", "damaged data", "export it again");
  return data;
}

}  // namespace

ParsedMesh parse_pcd(std::span<const std::byte> bytes, const std::string& name, double scale) {
  const PcdHeader header = parse_pcd_header(bytes, name);
  const WantedFields wanted = find_fields(header, name);
  ParsedMesh result;
  result.cloud.viewpoint = header.viewpoint * static_cast<float>(scale);
  const std::span<const std::byte> body = bytes.subspan(header.size);
  if (header.data == PcdHeader::Data::kAscii) {
    TextCursor cursor(bytes, name);
    cursor.skip_to(header.size);
    read_text(std::move(cursor), header, wanted, scale, result.cloud);
  } else if (header.data == PcdHeader::Data::kBinary) {
    check_room(header, header.point_size, body.size(), name);
    read_binary(lay_out(header, wanted, body.data(), false), header, wanted, scale, result.cloud);
  } else if (header.points > 0) {
    const std::vector<std::byte> data = decompress(body, header, name);
    read_binary(lay_out(header, wanted, data.data(), true), header, wanted, scale, result.cloud);
  }
  return result;
}

}  // namespace edgepose
