#include "canopen/object_dictionary.h"

#include <algorithm>

namespace edgepose {
namespace {

bool is_signed(ObjectType type) {
  return type == ObjectType::kI8 || type == ObjectType::kI16 || type == ObjectType::kI32;
}

}  // namespace

size_t bytes_of(ObjectType type) {
  switch (type) {
    case ObjectType::kU8:
    case ObjectType::kI8:
      return 1;
    case ObjectType::kU16:
    case ObjectType::kI16:
      return 2;
    case ObjectType::kU32:
    case ObjectType::kI32:
      return 4;
    case ObjectType::kText:
      return 0;
  }
  return 0;
}

void append_number(ObjectType type, int64_t value, std::vector<uint8_t>& bytes) {
  for (size_t i = 0; i < bytes_of(type); ++i)
    bytes.push_back(static_cast<uint8_t>(static_cast<uint64_t>(value) >> 8 * i));
}

int64_t number_from(ObjectType type, std::span<const uint8_t> bytes) {
  uint64_t value = 0;
  for (size_t i = 0; i < bytes.size(); ++i) value |= uint64_t{bytes[i]} << 8 * i;
  const size_t unused = 64 - 8 * bytes.size();
  if (!is_signed(type) || bytes.empty()) return static_cast<int64_t>(value);
  return static_cast<int64_t>(value << unused) >> unused;
}

void ObjectDictionary::add(const ObjectEntry& added) {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), added.id,
                                   [](const ObjectEntry& e, ObjectId id) { return e.id < id; });
  if (at != entries_.end() && at->id == added.id)
    *at = added;
  else
    entries_.insert(at, added);
}

const ObjectEntry* ObjectDictionary::find(ObjectId id) const {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), id,
                                   [](const ObjectEntry& e, ObjectId sought) { return e.id < sought; });
  return at != entries_.end() && at->id == id ? &*at : nullptr;
}

ObjectEntry* ObjectDictionary::entry(ObjectId id) { return const_cast<ObjectEntry*>(find(id)); }

int64_t ObjectDictionary::value(ObjectId id) const {
  const ObjectEntry* found = find(id);
  return found ? found->value : 0;
}

void ObjectDictionary::set(ObjectId id, int64_t value) {
  ObjectEntry* found = entry(id);
  if (!found || found->type == ObjectType::kText) return;
  const size_t unused = 64 - 8 * bytes_of(found->type);
  const uint64_t shifted = static_cast<uint64_t>(value) << unused;
  found->value = is_signed(found->type) ? static_cast<int64_t>(shifted) >> unused
                                        : static_cast<int64_t>(shifted >> unused);
}

SdoAbort ObjectDictionary::missing(ObjectId id) const {
  const bool index_known =
      std::any_of(entries_.begin(), entries_.end(), [&](const auto& e) { return e.id.index == id.index; });
  return index_known ? SdoAbort::kNoSubIndex : SdoAbort::kNoObject;
}

SdoAbort ObjectDictionary::read(ObjectId id, std::vector<uint8_t>& bytes) const {
  bytes.clear();
  const ObjectEntry* found = find(id);
  if (!found) return missing(id);
  if (found->type == ObjectType::kText)
    bytes.assign(found->text.begin(), found->text.end());
  else
    append_number(found->type, found->value, bytes);
  return SdoAbort::kNone;
}

SdoAbort ObjectDictionary::write(ObjectId id, std::span<const uint8_t> bytes) {
  ObjectEntry* found = entry(id);
  if (!found) return missing(id);
  if (found->access != ObjectAccess::kReadWrite) return SdoAbort::kReadOnly;
  if (found->type == ObjectType::kText) {
    if (bytes.size() > ObjectEntry::kMaxText) return SdoAbort::kTooLong;
    found->text.assign(bytes.begin(), bytes.end());
    return SdoAbort::kNone;
  }
  if (bytes.size() != bytes_of(found->type))
    return bytes.size() > bytes_of(found->type) ? SdoAbort::kTooLong : SdoAbort::kTooShort;
  const int64_t value = number_from(found->type, bytes);
  if (value > found->max) return SdoAbort::kTooHigh;
  if (value < found->min) return SdoAbort::kTooLow;
  if (const SdoAbort refused = guard_ ? guard_(id, value) : SdoAbort::kNone; refused != SdoAbort::kNone)
    return refused;
  found->value = value;
  return SdoAbort::kNone;
}

bool ObjectDictionary::write_mapped(ObjectId id, std::span<const uint8_t> bytes) {
  ObjectEntry* found = entry(id);
  if (!found || bytes.empty() || bytes.size() != bytes_of(found->type)) return false;
  const int64_t value = number_from(found->type, bytes);
  if (value > found->max || value < found->min) return false;
  found->value = value;
  return true;
}

}  // namespace edgepose
