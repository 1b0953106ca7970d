#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/scalar_type.h"

namespace edgepose {

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  bool is_list = false;
  ScalarType count_type = ScalarType::kUint8;  ///< lists only; an integer type
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;  ///< bounded by the bytes of the file if the element has properties
  std::vector<PlyProperty> properties;

  /// Position of a property, or -1.
  int find(const std::string& property) const;
};

struct PlyHeader {
  enum class Format { kAscii, kLittleEndian, kBigEndian };
  Format format = Format::kAscii;
  std::vector<PlyElement> elements;
  size_t size = 0;  ///< bytes up to the first element

  const PlyElement* find(const std::string& element) const;
};

/// Parses and checks the header: known format and types, no name twice, and no count that the rest of the
/// file cannot hold. Throws InputError.
PlyHeader parse_ply_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace edgepose
