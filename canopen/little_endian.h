#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace edgepose {

/// The integer at `offset`, in CANopen's byte order (CiA 301, 7.1.4.3). `bytes` must reach that far.
template <class Integer>
Integer read_little_endian(std::span<const uint8_t> bytes, size_t offset) {
  std::make_unsigned_t<Integer> value = 0;
  for (size_t i = sizeof(Integer); i-- > 0;)
    value = static_cast<decltype(value)>(static_cast<uint64_t>(value) << 8 | bytes[offset + i]);
  return static_cast<Integer>(value);
}

/// `bytes` must reach as far as offset + sizeof(Integer).
template <class Integer>
void write_little_endian(Integer value, std::span<uint8_t> bytes, size_t offset) {
  for (size_t i = 0; i < sizeof(Integer); ++i)
    bytes[offset + i] = static_cast<uint8_t>(
        static_cast<uint64_t>(static_cast<std::make_unsigned_t<Integer>>(value)) >> 8 * i);
}

}  // namespace edgepose
