#pragma once
#include <cstring>
#include <string>
#include <vector>

#include "messaging/big_endian.h"
#include "messaging/udpm_packet.h"

/// Datagrams as liblcm sends them, and others.
namespace edgepose::datagrams {

using Bytes = std::vector<std::byte>;

inline Bytes bytes_of(const std::string& text) {
  Bytes bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

inline void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

inline Bytes short_message(uint32_t sequence, const std::string& channel, const Bytes& payload) {
  Bytes datagram(8);
  write_big_endian<uint32_t>(0x4c433032, datagram, 0);
  write_big_endian<uint32_t>(sequence, datagram, 4);
  append(datagram, bytes_of(channel + '\0'));
  append(datagram, payload);
  return datagram;
}

struct FragmentHeader {
  uint32_t sequence = 1, message_size = 0, offset = 0;
  uint16_t fragment = 0, fragments = 2;
};

inline Bytes fragment(const FragmentHeader& header, const Bytes& rest) {
  Bytes datagram(20);
  write_big_endian<uint32_t>(0x4c433033, datagram, 0);
  write_big_endian<uint32_t>(header.sequence, datagram, 4);
  write_big_endian<uint32_t>(header.message_size, datagram, 8);
  write_big_endian<uint32_t>(header.offset, datagram, 12);
  write_big_endian<uint16_t>(header.fragment, datagram, 16);
  write_big_endian<uint16_t>(header.fragments, datagram, 18);
  append(datagram, rest);
  return datagram;
}

/// A message in pieces of `piece` bytes.
inline std::vector<Bytes> fragments(uint32_t sequence, const std::string& channel, const Bytes& message,
                                    size_t piece) {
  std::vector<Bytes> all;
  const size_t count = (message.size() + piece - 1) / piece;
  for (size_t i = 0; i < count; ++i) {
    Bytes rest = i == 0 ? bytes_of(channel + '\0') : Bytes{};
    const auto begin = message.begin() + static_cast<std::ptrdiff_t>(i * piece);
    const auto end = message.begin() + static_cast<std::ptrdiff_t>(std::min(message.size(), (i + 1) * piece));
    rest.insert(rest.end(), begin, end);
    all.push_back(fragment({sequence, static_cast<uint32_t>(message.size()), static_cast<uint32_t>(i * piece),
                            static_cast<uint16_t>(i), static_cast<uint16_t>(count)},
                           rest));
  }
  return all;
}

}  // namespace edgepose::datagrams
