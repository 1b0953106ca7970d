#pragma once
#include <cstddef>
#include <cstdint>

/// Classic pcap (draft-ietf-opsawg-pcap): a header of 24 bytes (magic u32, version 2.4 as two u16, zone and
/// accuracy u32 each, snapshot length u32, link type u32), then records: seconds u32, fraction u32, length
/// kept u32, length u32, bytes. In the byte order of who wrote it, which the magic number tells.
namespace edgepose::pcap_format {

inline constexpr uint32_t kMagicMicroseconds = 0xa1b2c3d4, kMagicNanoseconds = 0xa1b23c4d;
inline constexpr uint16_t kMajor = 2, kMinor = 4;
inline constexpr size_t kHeader = 24, kRecordHeader = 16;
inline constexpr uint32_t kLinkTypeCanSocketCan = 227;  ///< see bus/frame_record.h
/// Longer records are taken for damage; CAN FD's are of 72 bytes.
inline constexpr uint32_t kMaxRecord = 4096;

}  // namespace edgepose::pcap_format
