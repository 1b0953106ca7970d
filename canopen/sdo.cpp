#include "canopen/sdo.h"

#include <algorithm>

#include "canopen/little_endian.h"

namespace edgepose::sdo {

Bytes plain(uint8_t command, ObjectId id) {
  Bytes bytes{};
  bytes[0] = command;
  write_little_endian(id.index, bytes, 1);
  bytes[3] = id.sub;
  return bytes;
}

Bytes expedited(uint8_t command, ObjectId id, std::span<const uint8_t> data) {
  const size_t size = std::min(data.size(), kMaxExpedited);
  const auto unused = static_cast<uint8_t>((kMaxExpedited - size) << 2);
  Bytes bytes = plain(command | kExpedited | kSizeGiven | unused, id);
  std::copy_n(data.begin(), size, bytes.begin() + 4);
  return bytes;
}

Bytes segmented(uint8_t command, ObjectId id, uint32_t size) {
  Bytes bytes = plain(command | kSizeGiven, id);
  write_little_endian(size, bytes, 4);
  return bytes;
}

Bytes segment(uint8_t command, bool toggle, bool last, std::span<const uint8_t> data) {
  const size_t size = std::min(data.size(), kMaxSegment);
  Bytes bytes{};
  bytes[0] =
      static_cast<uint8_t>(command | (toggle ? kToggle : 0) | (kMaxSegment - size) << 1 | (last ? kLast : 0));
  std::copy_n(data.begin(), size, bytes.begin() + 1);
  return bytes;
}

Bytes abort(ObjectId id, SdoAbort reason) {
  Bytes bytes = plain(kAbort, id);
  write_little_endian(static_cast<uint32_t>(reason), bytes, 4);
  return bytes;
}

ObjectId object_of(const Bytes& bytes) { return {read_little_endian<uint16_t>(bytes, 1), bytes[3]}; }

SdoAbort reason_of(const Bytes& bytes) {
  return static_cast<SdoAbort>(read_little_endian<uint32_t>(bytes, 4));
}

std::span<const uint8_t> expedited_data(const Bytes& bytes) {
  const size_t unused = bytes[0] & kSizeGiven ? bytes[0] >> 2 & 3 : 0;
  return std::span(bytes).subspan(4, kMaxExpedited - unused);
}

std::span<const uint8_t> segment_data(const Bytes& bytes) {
  return std::span(bytes).subspan(1, kMaxSegment - (bytes[0] >> 1 & 7));
}

uint32_t announced_size(const Bytes& bytes) {
  return bytes[0] & kSizeGiven ? read_little_endian<uint32_t>(bytes, 4) : 0;
}

}  // namespace edgepose::sdo
