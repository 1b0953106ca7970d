#include "canopen/drive_pdo.h"

#include "canopen/pdo.h"

namespace edgepose {
namespace {

/// Calls `visit` with each mapped object and where its bytes begin; gives the length of all [bytes].
template <class Visit>
size_t for_mapped(const ObjectDictionary& objects, uint16_t mapping, Visit visit) {
  size_t at = 0;
  const int64_t count = objects.value({mapping, 0});
  for (uint8_t i = 1; i <= count; ++i) {
    const auto mapped = MappedObject::from(static_cast<uint32_t>(objects.value({mapping, i})));
    const size_t bytes = mapped.bits / 8;
    if (at + bytes > 8) break;
    visit(mapped.id, at, bytes);
    at += bytes;
  }
  return at;
}

}  // namespace

void pack_pdo(const ObjectDictionary& objects, uint16_t mapping, CanFrame& frame) {
  frame.size = static_cast<uint8_t>(for_mapped(objects, mapping, [&](ObjectId id, size_t at, size_t bytes) {
    const auto value = static_cast<uint64_t>(objects.value(id));
    for (size_t i = 0; i < bytes; ++i) frame.data[at + i] = static_cast<uint8_t>(value >> 8 * i);
  }));
}

bool unpack_pdo(ObjectDictionary& objects, uint16_t mapping, const CanFrame& frame) {
  const auto nothing = [](ObjectId, size_t, size_t) {};
  if (for_mapped(objects, mapping, nothing) > frame.size) return false;
  for_mapped(objects, mapping, [&](ObjectId id, size_t at, size_t bytes) {
    objects.write_mapped(id, std::span(frame.data).subspan(at, bytes));
  });
  return true;
}

}  // namespace edgepose
