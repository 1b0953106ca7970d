#include "files/ply_header.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "common/error.h"
#include "files/mesh_format.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

// Far beyond any real file; keeps the searches for doubled names short.
constexpr size_t kMostElements = 100, kMostProperties = 1000;

std::optional<ScalarType> scalar_type(std::string_view name) {
  struct Name {
    std::string_view name;
    ScalarType type;
  };
  static constexpr Name kNames[] = {
      {"char", ScalarType::kInt8},       {"int8", ScalarType::kInt8},      {"uchar", ScalarType::kUint8},
      {"uint8", ScalarType::kUint8},     {"short", ScalarType::kInt16},    {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16},   {"uint16", ScalarType::kUint16},  {"int", ScalarType::kInt32},
      {"int32", ScalarType::kInt32},     {"uint", ScalarType::kUint32},    {"uint32", ScalarType::kUint32},
      {"int64", ScalarType::kInt64},     {"uint64", ScalarType::kUint64},  {"float", ScalarType::kFloat32},
      {"float32", ScalarType::kFloat32}, {"double", ScalarType::kFloat64}, {"float64", ScalarType::kFloat64}};
  for (const Name& known : kNames) {
    if (known.name == name) return known.type;
  }
  return std::nullopt;
}

ScalarType parse_type(const TextCursor& cursor, std::string_view token) {
  const std::optional<ScalarType> type = scalar_type(token);
  if (!type) cursor.fail_at_token("a type (char, uchar, short, ushort, int, uint, float, double)", token);
  return *type;
}

PlyHeader::Format parse_format(const TextCursor& cursor, std::string_view rest) {
  const std::string_view format = next_token(rest);
  const std::string_view version = next_token(rest);
  if (version != "1.0") cursor.fail("PLY version 1.0", quoted(version));
  if (format == "ascii") return PlyHeader::Format::kAscii;
  if (format == "binary_little_endian") return PlyHeader::Format::kLittleEndian;
  if (format == "binary_big_endian") return PlyHeader::Format::kBigEndian;
  cursor.fail("format ascii, binary_little_endian or binary_big_endian", quoted(format));
}

PlyElement parse_element(const TextCursor& cursor, std::string_view rest) {
  PlyElement element;
  element.name = next_token(rest);
  const std::string_view count = next_token(rest);
  const std::optional<uint64_t> parsed = parse_count(count);
  if (element.name.empty() || !parsed) cursor.fail("'element NAME COUNT'", "a count of " + quoted(count));
  element.count = *parsed;
  return element;
}

PlyProperty parse_property(const TextCursor& cursor, std::string_view rest) {
  PlyProperty property;
  std::string_view type = next_token(rest);
  property.is_list = type == "list";
  if (property.is_list) {
    const std::string_view count_type = next_token(rest);
    property.count_type = parse_type(cursor, count_type);
    if (!is_integer(property.count_type))
      cursor.fail("an integer type for the length of a list", quoted(count_type));
    type = next_token(rest);
  }
  property.type = parse_type(cursor, type);
  property.name = next_token(rest);
  if (property.name.empty()) cursor.fail("a property with a name", "none");
  return property;
}

/// Fewest bytes that one element takes: lists may be empty; in text each value takes two characters.
uint64_t least_size(const PlyElement& element, PlyHeader::Format format) {
  uint64_t size = 0;
  for (const PlyProperty& property : element.properties) {
    if (format == PlyHeader::Format::kAscii) {
      size += 2;
    } else {
      size += size_of(property.is_list ? property.count_type : property.type);
    }
  }
  return size;
}

void check_counts(const PlyHeader& header, size_t file_size, const std::string& name) {
  // The last value of a text file needs no white space after it.
  uint64_t left = file_size - header.size + (header.format == PlyHeader::Format::kAscii ? 1 : 0);
  for (const PlyElement& element : header.elements) {
    const uint64_t size = least_size(element, header.format);
    if (size == 0) continue;
    if (element.count > left / size) {
      throw InputError::at(
          name,
          "at least " + std::to_string(size) + " bytes for each of the " + std::to_string(element.count) +
              " elements '" + element.name + "' that the header announces",
          std::to_string(left) + " bytes for them", "the file is cut short or its header is wrong");
    }
    left -= element.count * size;
  }
}

}  // namespace

int PlyElement::find(const std::string& property) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const PlyProperty& p) { return p.name == property; });
  return found == properties.end() ? -1 : static_cast<int>(found - properties.begin());
}

const PlyElement* PlyHeader::find(const std::string& element) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == element; });
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader parse_ply_header(std::span<const std::byte> bytes, const std::string& name) {
  if (!starts_as_ply(bytes)) {
    throw InputError::at(name, "a PLY file, which starts with the line 'ply'", describe_content(bytes));
  }
  TextCursor cursor(bytes, name);
  PlyHeader header;
  bool format_seen = false;
  cursor.line();
  for (;;) {
    if (cursor.at_end()) cursor.fail("a PLY header up to the line 'end_header'", "the end of the file");
    std::string_view rest = cursor.line();
    const std::string_view keyword = next_token(rest);
    if (keyword == "end_header") break;
    if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) continue;
    if (keyword == "format") {
      header.format = parse_format(cursor, rest);
      format_seen = true;
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(cursor, rest));
      if (header.find(header.elements.back().name) != &header.elements.back()) {
        cursor.fail("each element once", edgepose::quoted(header.elements.back().name) + " twice");
      }
      if (header.elements.size() > kMostElements) cursor.fail("at most 100 elements", "more");
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("an element before its properties", "a property");
      PlyElement& element = header.elements.back();
      element.properties.push_back(parse_property(cursor, rest));
      if (element.find(element.properties.back().name) + 1 != static_cast<int>(element.properties.size())) {
        cursor.fail("each property once", edgepose::quoted(element.properties.back().name) + " twice");
      }
      if (element.properties.size() > kMostProperties) cursor.fail("at most 1000 properties", "more");
    } else {
      cursor.fail("a line of a PLY header (format, element, property, comment, end_header)", quoted(keyword));
    }
  }
  if (!format_seen) throw InputError::at(name, "a line 'format ...' in the PLY header", "none");
  header.size = cursor.position();
  // Where lines end with \r alone, a \n after the header is data.
  const auto character = [&](size_t i) { return static_cast<char>(bytes[i]); };
  if (character(3) == '\r' && character(4) != '\n' && character(header.size - 1) == '\n') --header.size;
  check_counts(header, bytes.size(), name);
  return header;
}

}  // namespace edgepose
