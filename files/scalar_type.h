#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

namespace edgepose {

/// Number types that PLY and PCD files are made of.
enum class ScalarType : uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

constexpr size_t size_of(ScalarType type) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

constexpr bool is_integer(ScalarType type) { return type < ScalarType::kFloat32; }

namespace detail {
template <typename T>
double load_as(const std::byte* from, bool swap_bytes) {
  std::byte raw[sizeof(T)];
  std::memcpy(raw, from, sizeof(T));
  if (swap_bytes) {
    for (size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
  }
  return static_cast<double>(std::bit_cast<T>(raw));
}
}  // namespace detail

/// The number at `from` (size_of(type) bytes, any alignment). 64-bit integers beyond 2^53 are rounded.
inline double load_scalar(const std::byte* from, ScalarType type, bool swap_bytes) {
  switch (type) {
    case ScalarType::kInt8:
      return detail::load_as<int8_t>(from, swap_bytes);
    case ScalarType::kUint8:
      return detail::load_as<uint8_t>(from, swap_bytes);
    case ScalarType::kInt16:
      return detail::load_as<int16_t>(from, swap_bytes);
    case ScalarType::kUint16:
      return detail::load_as<uint16_t>(from, swap_bytes);
    case ScalarType::kInt32:
      return detail::load_as<int32_t>(from, swap_bytes);
    case ScalarType::kUint32:
      return detail::load_as<uint32_t>(from, swap_bytes);
    case ScalarType::kInt64:
      return detail::load_as<int64_t>(from, swap_bytes);
    case ScalarType::kUint64:
      return detail::load_as<uint64_t>(from, swap_bytes);
    case ScalarType::kFloat32:
      return detail::load_as<float>(from, swap_bytes);
    case ScalarType::kFloat64:
      return detail::load_as<double>(from, swap_bytes);
  }
  return 0;
}

}  // namespace edgepose
