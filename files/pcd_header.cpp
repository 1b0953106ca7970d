#include "files/pcd_header.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/error.h"
#include "files/mesh_format.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

// Far beyond any real file, so that products stay small.
constexpr size_t kMostFields = 1000, kMostPointSize = 1 << 20, kMostPoints = 0xffffffff;

class HeaderReader {
 public:
  HeaderReader(std::span<const std::byte> bytes, const std::string& name) : cursor_(bytes, name) {}

  PcdHeader read() {
    for (bool more = true; more;) {
      if (cursor_.at_end()) cursor_.fail("a PCD header up to the line 'DATA'", "the end of the file");
      more = read_line(cursor_.line());
    }
    if (header_.fields.empty()) fail_missing("FIELDS");
    if (sizes_.empty()) fail_missing("SIZE");
    if (types_.empty()) fail_missing("TYPE");
    lay_out_fields();
    count_points();
    header_.size = cursor_.position();
    return std::move(header_);
  }

 private:
  /// False after the last line of the header.
  bool read_line(std::string_view line) {
    const std::string_view keyword = next_token(line);
    if (keyword.empty() || keyword[0] == '#') return true;
    if (keyword == "VERSION") {
      read_version(line);
    } else if (keyword == "FIELDS" || keyword == "COLUMNS") {
      for (const std::string_view field : words(line)) header_.fields.push_back({.name = std::string(field)});
    } else if (keyword == "SIZE") {
      sizes_ = counts(line);
    } else if (keyword == "TYPE") {
      types_ = words(line);
    } else if (keyword == "COUNT") {
      counts_ = counts(line);
    } else if (keyword == "WIDTH") {
      width_ = one_count(line);
    } else if (keyword == "HEIGHT") {
      height_ = one_count(line);
    } else if (keyword == "POINTS") {
      points_ = one_count(line);
    } else if (keyword == "VIEWPOINT") {
      read_viewpoint(line);
    } else if (keyword == "DATA") {
      read_data(line);
      return false;
    } else {
      cursor_.fail("a line of a PCD header (VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, DATA)",
                   quoted(keyword));
    }
    return true;
  }

  std::vector<std::string_view> words(std::string_view line) const {
    std::vector<std::string_view> result;
    for (std::string_view word = next_token(line); !word.empty(); word = next_token(line))
      result.push_back(word);
    if (result.empty()) cursor_.fail("values", "the end of the line");
    if (result.size() > kMostFields) cursor_.fail("at most 1000 fields", std::to_string(result.size()));
    return result;
  }

  std::vector<size_t> counts(std::string_view line) const {
    std::vector<size_t> result;
    for (const std::string_view word : words(line)) result.push_back(one_count(word));
    return result;
  }

  size_t one_count(std::string_view line) const {
    const std::string_view word = next_token(line);
    const std::optional<uint64_t> count = parse_count(word);
    if (!count || *count > kMostPoints)
      cursor_.fail("a count up to " + std::to_string(kMostPoints), quoted(word));
    return *count;
  }

  void read_version(std::string_view line) const {
    const std::string_view version = next_token(line);
    for (const char* known : {"0.7", ".7", "0.6", ".6", "0.5", ".5"}) {
      if (version == known) return;
    }
    cursor_.fail("PCD version 0.7", quoted(version));
  }

  /// x y z, then a quaternion that matters to nobody here.
  void read_viewpoint(std::string_view line) {
    for (float& value : header_.viewpoint) {
      const std::string_view word = next_token(line);
      const std::optional<double> number = parse_number(word);
      if (!number || !(std::abs(*number) < 1e9)) cursor_.fail("a position", quoted(word));
      value = static_cast<float>(*number);
    }
  }

  void read_data(std::string_view line) {
    const std::string_view data = next_token(line);
    if (data == "ascii") {
      header_.data = PcdHeader::Data::kAscii;
    } else if (data == "binary") {
      header_.data = PcdHeader::Data::kBinary;
    } else if (data == "binary_compressed") {
      header_.data = PcdHeader::Data::kCompressed;
    } else {
      cursor_.fail("DATA ascii, binary or binary_compressed", quoted(data));
    }
  }

  void lay_out_fields() {
    if (counts_.empty()) counts_.assign(header_.fields.size(), 1);
    for (const size_t size : {sizes_.size(), types_.size(), counts_.size()}) {
      if (size == header_.fields.size()) continue;
      cursor_.fail(
          "one SIZE, TYPE and COUNT for each of the " + std::to_string(header_.fields.size()) + " FIELDS",
          std::to_string(size));
    }
    for (size_t i = 0; i < header_.fields.size(); ++i) {
      PcdField& field = header_.fields[i];
      field.type = scalar_type(types_[i], sizes_[i]);
      field.count = counts_[i];
      field.offset = header_.point_size;
      if (field.count == 0 || field.count > kMostPointSize) {
        cursor_.fail("a COUNT from 1 to " + std::to_string(kMostPointSize), std::to_string(field.count));
      }
      header_.point_size += field.size();
    }
    if (header_.point_size > kMostPointSize) {
      cursor_.fail("points of at most " + std::to_string(kMostPointSize) + " bytes",
                   std::to_string(header_.point_size));
    }
  }

  ScalarType scalar_type(std::string_view type, size_t size) const {
    struct Known {
      std::string_view type;
      size_t size;
      ScalarType scalar;
    };
    constexpr Known kKnown[] = {{"I", 1, ScalarType::kInt8},    {"I", 2, ScalarType::kInt16},
                                {"I", 4, ScalarType::kInt32},   {"I", 8, ScalarType::kInt64},
                                {"U", 1, ScalarType::kUint8},   {"U", 2, ScalarType::kUint16},
                                {"U", 4, ScalarType::kUint32},  {"U", 8, ScalarType::kUint64},
                                {"F", 4, ScalarType::kFloat32}, {"F", 8, ScalarType::kFloat64}};
    for (const Known& known : kKnown) {
      if (known.type == type && known.size == size) return known.scalar;
    }
    cursor_.fail("TYPE I or U with SIZE 1, 2, 4, 8, or F with SIZE 4, 8",
                 quoted(type) + " with " + std::to_string(size));
  }

  void count_points() {
    if (!width_ && !points_) fail_missing("WIDTH");
    const size_t height = height_.value_or(1);
    const size_t points = width_ ? *width_ * height : *points_;  // no overflow: both fit 32 bits
    if (points > kMostPoints)
      cursor_.fail("at most " + std::to_string(kMostPoints) + " points", std::to_string(points));
    if (points_ && *points_ != points) {
      cursor_.fail("POINTS equal to WIDTH times HEIGHT = " + std::to_string(points),
                   std::to_string(*points_));
    }
    header_.points = points;
  }

  [[noreturn]] void fail_missing(const char* keyword) const {
    throw InputError::at(cursor_.name(), std::string("a line '") + keyword + " ...' in the PCD header",
                         "none");
  }

  TextCursor cursor_;
  PcdHeader header_;
  std::vector<size_t> sizes_, counts_;
  std::vector<std::string_view> types_;
  std::optional<size_t> width_, height_, points_;
};

}  // namespace

int PcdHeader::find(const std::string& field) const {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const PcdField& f) { return f.name == field; });
  return found == fields.end() || found->count != 1 ? -1 : static_cast<int>(found - fields.begin());
}

PcdHeader parse_pcd_header(std::span<const std::byte> bytes, const std::string& name) {
  if (format_of_content(bytes) != MeshFormat::kPcd) {
    throw InputError::at(name, "a PCD file, which starts with '# .PCD' or 'VERSION'",
                         describe_content(bytes));
  }
  return HeaderReader(bytes, name).read();
}

}  // namespace edgepose
