#include "messaging/udpm_packet.h"

#include <algorithm>

#include "messaging/big_endian.h"

namespace edgepose {
namespace {

// liblcm's udpm protocol, all numbers big endian.
//   short:    magic u32, sequence u32, channel, NUL, payload
//   fragment: magic u32, sequence u32, message size u32, offset u32, fragment u16, fragments u16;
//             the first: channel, NUL; payload
constexpr uint32_t kShortMagic = 0x4c433032, kFragmentMagic = 0x4c433033;
constexpr size_t kShortHeader = 8, kFragmentHeader = 20;

/// Splits "channel NUL payload".
bool take_channel(std::span<const std::byte> rest, UdpmPacket& packet) {
  const auto end =
      std::find(rest.begin(), rest.begin() + std::min(rest.size(), kMaxChannelLength + 1), std::byte{0});
  const auto length = static_cast<size_t>(end - rest.begin());
  if (length == 0 || length > kMaxChannelLength || length == rest.size()) return false;
  packet.channel = {reinterpret_cast<const char*>(rest.data()), length};
  packet.payload = rest.subspan(length + 1);
  return std::all_of(packet.channel.begin(), packet.channel.end(),
                     [](char c) { return c > ' ' && c <= '~'; });
}

UdpmFault parse_fragment(std::span<const std::byte> datagram, UdpmPacket& packet) {
  if (datagram.size() < kFragmentHeader) return UdpmFault::kTooShort;
  packet.message_size = read_big_endian<uint32_t>(datagram, 8);
  packet.offset = read_big_endian<uint32_t>(datagram, 12);
  packet.fragment = read_big_endian<uint16_t>(datagram, 16);
  packet.fragments = read_big_endian<uint16_t>(datagram, 18);
  packet.payload = datagram.subspan(kFragmentHeader);
  if (packet.fragment == 0 && !take_channel(packet.payload, packet)) return UdpmFault::kBadChannel;
  const bool sound = packet.fragment < packet.fragments && !packet.payload.empty() &&
                     uint64_t{packet.offset} + packet.payload.size() <= packet.message_size &&
                     (packet.fragment == 0) == (packet.offset == 0);
  return sound ? UdpmFault::kNone : UdpmFault::kBadFragment;
}

}  // namespace

UdpmFault parse_udpm(std::span<const std::byte> datagram, UdpmPacket& packet) {
  packet = {};
  if (datagram.size() < kShortHeader) return UdpmFault::kTooShort;
  const auto magic = read_big_endian<uint32_t>(datagram, 0);
  packet.sequence = read_big_endian<uint32_t>(datagram, 4);
  if (magic == kFragmentMagic) return parse_fragment(datagram, packet);
  if (magic != kShortMagic) return UdpmFault::kWrongMagic;
  if (!take_channel(datagram.subspan(kShortHeader), packet)) return UdpmFault::kBadChannel;
  packet.message_size = static_cast<uint32_t>(packet.payload.size());
  return UdpmFault::kNone;
}

}  // namespace edgepose
