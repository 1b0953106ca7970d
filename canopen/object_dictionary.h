#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "canopen/objects.h"
#include "canopen/sdo_abort.h"

namespace edgepose {

enum class ObjectType : uint8_t { kU8, kI8, kU16, kI16, kU32, kI32, kText };
enum class ObjectAccess : uint8_t { kConst, kReadOnly, kReadWrite };

/// [bytes] of a number; 0 for text.
size_t bytes_of(ObjectType type);

struct ObjectEntry {
  ObjectId id;
  ObjectType type = ObjectType::kU32;
  ObjectAccess access = ObjectAccess::kReadOnly;
  int64_t value = 0;  ///< its default at first
  int64_t min = INT64_MIN, max = INT64_MAX;
  bool mappable = false;  ///< into a PDO
  std::string text{};     ///< if kText; of at most kMaxText bytes
  static constexpr size_t kMaxText = 64;
};

/// The objects of a device (CiA 301, 7.4): numbers and texts with type, access, default and range.
class ObjectDictionary {
 public:
  /// Asked before a number is written from outside: kNone lets it pass.
  using Guard = std::function<SdoAbort(ObjectId id, int64_t value)>;

  /// Replaces the entry of this id, if there is one.
  void add(const ObjectEntry& entry);
  void set_guard(Guard guard) { guard_ = std::move(guard); }

  const ObjectEntry* find(ObjectId id) const;  ///< nullptr: no such entry
  int64_t value(ObjectId id) const;            ///< 0 if there is no such entry
  /// For the device itself: whatever its access; wraps as its type does.
  void set(ObjectId id, int64_t value);

  /// For others, by SDO. `bytes` is replaced.
  SdoAbort read(ObjectId id, std::vector<uint8_t>& bytes) const;
  SdoAbort write(ObjectId id, std::span<const uint8_t> bytes);
  /// For others, by PDO: a number that is not within its range, or too short, is left as it was.
  bool write_mapped(ObjectId id, std::span<const uint8_t> bytes);

 private:
  ObjectEntry* entry(ObjectId id);
  SdoAbort missing(ObjectId id) const;

  std::vector<ObjectEntry> entries_;  // by id
  Guard guard_;
};

/// A number in CANopen's byte order, of the type's size, and back.
void append_number(ObjectType type, int64_t value, std::vector<uint8_t>& bytes);
/// `bytes` must be of the type's size.
int64_t number_from(ObjectType type, std::span<const uint8_t> bytes);

}  // namespace edgepose
