#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace edgepose {

/// LCM allows no longer channel names.
inline constexpr size_t kMaxChannelLength = 63;

/// One datagram of LCM's UDP multicast protocol: a short message ("LC02"), or a fragment of a long one
/// ("LC03"). Views into the datagram.
struct UdpmPacket {
  uint32_t sequence = 0;               ///< of the message, counted by its sender
  std::string_view channel;            ///< empty in all fragments but the first
  std::span<const std::byte> payload;  ///< the message, or the fragment's part of it
  uint32_t message_size = 0;           ///< bytes of the whole message
  uint32_t offset = 0;                 ///< of the payload in the message
  uint16_t fragment = 0;               ///< number of this one, from 0
  uint16_t fragments = 1;              ///< of the message; 1 = short
};

/// Why a datagram is none of LCM's.
enum class UdpmFault {
  kNone,
  kTooShort,     ///< ends within its header
  kWrongMagic,   ///< neither LC02 nor LC03
  kBadChannel,   ///< no end, empty, longer than 63 or not printable
  kBadFragment,  ///< number, offset or size contradict each other
};

/// Takes a datagram apart. `packet` is valid only if the answer is kNone; then its payload lies within the
/// message and its numbers agree with each other. Never reads beyond `datagram`, whatever it says.
UdpmFault parse_udpm(std::span<const std::byte> datagram, UdpmPacket& packet);

}  // namespace edgepose
