#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "files/scalar_type.h"

namespace edgepose {

/// A field of every point: `count` values of one type, one after another.
struct PcdField {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  size_t count = 1;
  size_t offset = 0;  ///< bytes from the start of a point

  size_t size() const { return count * size_of(type); }
};

struct PcdHeader {
  enum class Data { kAscii, kBinary, kCompressed };
  std::vector<PcdField> fields;
  size_t points = 0;
  size_t point_size = 0;                                ///< bytes of all fields, at most kMostPointSize
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();  ///< position only, in the unit of the file
  Data data = Data::kAscii;
  size_t size = 0;  ///< bytes up to the first point

  /// Position of a field with one value, or -1.
  int find(const std::string& field) const;
};

/// Parses and checks a header of version 0.5 to 0.7; the number of points is not yet compared with the file's
/// size. Throws InputError.
PcdHeader parse_pcd_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace edgepose
