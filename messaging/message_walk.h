#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace edgepose {

/// Goes through an encoded LCM message field by field, without decoding it, and finds out whether its lengths
/// can be true. The decoders that lcm-gen makes trust them: a message of 34 bytes makes them allocate 2 GB
/// (docs/lcm.md). After the first fault all further calls do nothing and counts are 0.
class MessageWalk {
 public:
  explicit MessageWalk(std::span<const std::byte> bytes) : rest_(bytes) {}

  /// The type's hash, which stands first.
  MessageWalk& fingerprint(int64_t expected);
  /// Fields of fixed size.
  MessageWalk& skip(size_t bytes);
  MessageWalk& text(const char* field, int32_t max_length);
  /// A length field: 0 to `max`, and not more than what remains can hold if each item takes `least_bytes`.
  int32_t count(const char* field, int32_t max, size_t least_bytes);
  /// A length field and an array of items of one fixed size, which follows it at once.
  MessageWalk& array(const char* field, int32_t max, size_t item_bytes);
  /// Nothing may be left.
  void end();

  /// Empty, or what is wrong: "FIELD: expected E, found F".
  const std::string& fault() const { return fault_; }

 private:
  template <class Integer>
  Integer take();
  void fail(const std::string& what);

  std::span<const std::byte> rest_;
  std::string fault_;
};

}  // namespace edgepose
