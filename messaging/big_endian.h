#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace edgepose {

/// The integer that starts at `offset`, in network byte order. `bytes` must reach that far.
template <class Integer>
Integer read_big_endian(std::span<const std::byte> bytes, size_t offset) {
  std::make_unsigned_t<Integer> value = 0;
  for (size_t i = 0; i < sizeof(Integer); ++i)
    value = static_cast<decltype(value)>(value << 8 | std::to_integer<uint8_t>(bytes[offset + i]));
  return static_cast<Integer>(value);
}

/// Writes the integer from `offset` on, in network byte order. `bytes` must reach that far.
template <class Integer>
void write_big_endian(Integer value, std::span<std::byte> bytes, size_t offset) {
  for (size_t i = 0; i < sizeof(Integer); ++i)
    bytes[offset + i] = static_cast<std::byte>(
        static_cast<std::make_unsigned_t<Integer>>(value) >> (8 * (sizeof(Integer) - 1 - i)) & 0xff);
}

}  // namespace edgepose
