#include "messaging/message_walk.h"

#include "messaging/big_endian.h"

namespace edgepose {

void MessageWalk::fail(const std::string& what) {
  if (fault_.empty()) fault_ = what;
  rest_ = {};
}

template <class Integer>
Integer MessageWalk::take() {
  if (rest_.size() < sizeof(Integer)) {
    fail("message: expected more bytes, found its end");
    return 0;
  }
  const auto value = read_big_endian<Integer>(rest_, 0);
  rest_ = rest_.subspan(sizeof(Integer));
  return value;
}

MessageWalk& MessageWalk::fingerprint(int64_t expected) {
  if (fault_.empty() && take<int64_t>() != expected)
    fail("fingerprint: expected this type's, found another type's or another version's");
  return *this;
}

MessageWalk& MessageWalk::skip(size_t bytes) {
  if (!fault_.empty()) return *this;
  if (rest_.size() < bytes) {
    fail("message: expected more bytes, found its end");
  } else {
    rest_ = rest_.subspan(bytes);
  }
  return *this;
}

/// LCM's strings: length with the closing NUL, characters, NUL.
MessageWalk& MessageWalk::text(const char* field, int32_t max_length) {
  if (!fault_.empty()) return *this;
  const auto size = take<int32_t>();
  if (!fault_.empty()) return *this;
  if (size < 1 || size - 1 > max_length || static_cast<size_t>(size) > rest_.size()) {
    fail(std::string(field) + ": expected at most " + std::to_string(max_length) +
         " bytes, found the length " + std::to_string(int64_t{size} - 1));
    return *this;
  }
  const auto characters = rest_.first(static_cast<size_t>(size));
  for (size_t i = 0; i < characters.size(); ++i)
    if ((characters[i] == std::byte{0}) != (i + 1 == characters.size())) {
      fail(std::string(field) + ": expected a zero byte at its end only, found another");
      return *this;
    }
  rest_ = rest_.subspan(characters.size());
  return *this;
}

int32_t MessageWalk::count(const char* field, int32_t max, size_t least_bytes) {
  if (!fault_.empty()) return 0;
  const auto n = take<int32_t>();
  if (!fault_.empty()) return 0;
  if (n < 0 || n > max || static_cast<uint64_t>(n) * least_bytes > rest_.size()) {
    fail(std::string(field) + ": expected 0 to " + std::to_string(max) +
         " that fit into the message, found " + std::to_string(n));
    return 0;
  }
  return n;
}

MessageWalk& MessageWalk::array(const char* field, int32_t max, size_t item_bytes) {
  return skip(static_cast<size_t>(count(field, max, item_bytes)) * item_bytes);
}

void MessageWalk::end() {
  if (fault_.empty() && !rest_.empty())
    fail("message: expected its end, found " + std::to_string(rest_.size()) + " more bytes");
}

}  // namespace edgepose
