#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "common/error.h"
#include "files/number_text.h"
#include "files/ply_header.h"
#include "files/scalar_type.h"
#include "files/text_cursor.h"

namespace edgepose {

/// Values of a binary PLY body, each checked against the end of the file. Same members as PlyTextBody.
class PlyBinaryBody {
 public:
  PlyBinaryBody(std::span<const std::byte> bytes, std::string name, bool swap_bytes)
      : bytes_(bytes), name_(std::move(name)), swap_bytes_(swap_bytes) {}

  double value(ScalarType type) {
    const size_t size = size_of(type);
    if (size > bytes_.size() - position_)
      fail("as much data as the PLY header announces", "the end of the file");
    const double result = load_scalar(bytes_.data() + position_, type, swap_bytes_);
    position_ += size;
    return result;
  }
  void skip(size_t count, ScalarType type) {
    if (count > (bytes_.size() - position_) / size_of(type)) {
      fail("a list of " + std::to_string(count) + " values", "the end of the file");
    }
    position_ += count * size_of(type);
  }
  void finish() const {
    if (position_ == bytes_.size()) return;
    fail("the end of the file after all that the PLY header announces",
         std::to_string(bytes_.size() - position_) + " more bytes");
  }
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw InputError::at(name_, expected, found, "the file is cut short or damaged, export it again");
  }

 private:
  std::span<const std::byte> bytes_;
  size_t position_ = 0;
  std::string name_;
  bool swap_bytes_;
};

/// Values of a text PLY body; where lines end does not matter, as in other readers.
class PlyTextBody {
 public:
  explicit PlyTextBody(TextCursor cursor) : cursor_(std::move(cursor)) {}

  double value(ScalarType) { return cursor_.number("PLY value"); }
  void skip(size_t count, ScalarType) {
    for (size_t i = 0; i < count; ++i) {
      if (cursor_.token().empty()) cursor_.fail_at_token("as much data as the PLY header announces", "");
    }
  }
  void finish() {
    const std::string_view token = cursor_.token();
    if (!token.empty()) fail("the end of the file after all that the PLY header announces", quoted(token));
  }
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    cursor_.fail(expected, found);
  }

 private:
  TextCursor cursor_;
};

/// Reads a whole number from 0 to `most`; fails (naming `what`) otherwise. Text may hold anything.
template <typename Body>
size_t read_whole_number(Body& body, ScalarType type, double most, const char* what) {
  const double value = body.value(type);
  // NaN fails, too. Below 2^53 every double converts without loss.
  if (!(value >= 0 && value <= most && value == static_cast<double>(static_cast<size_t>(value)))) {
    body.fail(std::string(what) + " from 0 to " + number_text(most, 12), number_text(value, 12));
  }
  return static_cast<size_t>(value);
}

template <typename Body>
size_t read_list_length(Body& body, const PlyProperty& list) {
  return read_whole_number(body, list.count_type, 1e15, "the length of a list");
}

template <typename Body>
void skip_property(Body& body, const PlyProperty& property) {
  body.skip(property.is_list ? read_list_length(body, property) : 1, property.type);
}

}  // namespace edgepose
