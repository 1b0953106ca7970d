#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "bus/can_bus.h"

namespace edgepose {

/// A frame as bytes: `struct can_frame` with the identifier in network byte order, as captures of link type
/// LINKTYPE_CAN_SOCKETCAN (227) have it: id u32, length u8, 3 bytes of padding, 8 of data. The Unix socket
/// bus uses the same.
inline constexpr size_t kFrameRecordBytes = 16;
using FrameRecord = std::array<uint8_t, kFrameRecordBytes>;

FrameRecord to_record(const CanFrame& frame);

/// A frame or, from an error frame, an event; nothing if it is neither (extended, remote or FD frame, wrong
/// length). The record may end after its data, as captures may. Time is not part of it.
Received from_record(std::span<const uint8_t> record);

}  // namespace edgepose
