#include "bus/frame_record.h"

#include <linux/can.h>

#include <algorithm>

namespace edgepose {
namespace {

constexpr size_t kRecordHeader = 8;

}  // namespace

FrameRecord to_record(const CanFrame& frame) {
  FrameRecord record{};
  record[2] = static_cast<uint8_t>(frame.id >> 8);
  record[3] = static_cast<uint8_t>(frame.id);
  record[4] = std::min<uint8_t>(frame.size, 8);
  std::copy_n(frame.data.begin(), record[4], record.begin() + kRecordHeader);
  return record;
}

Received from_record(std::span<const uint8_t> record) {
  Received read;
  if (record.size() < kRecordHeader || record.size() > kFrameRecordBytes) return read;
  const uint32_t id =
      uint32_t{record[0]} << 24 | uint32_t{record[1]} << 16 | uint32_t{record[2]} << 8 | record[3];
  const size_t size = record[4];
  if (size > 8 || kRecordHeader + size > record.size()) return read;
  std::copy_n(record.begin() + kRecordHeader, size, read.frame.data.begin());
  if (id & CAN_ERR_FLAG) {
    read.kind = Received::Kind::kEvent;
    read.event = bus_event_of(id & CAN_ERR_MASK, read.frame.data);
    return read;
  }
  if (id & (CAN_EFF_FLAG | CAN_RTR_FLAG) || id > CanFrame::kMaxId) return Received{};
  read.kind = Received::Kind::kFrame;
  read.frame.id = static_cast<uint16_t>(id);
  read.frame.size = static_cast<uint8_t>(size);
  return read;
}

}  // namespace edgepose
