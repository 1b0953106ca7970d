#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace edgepose {

/// A data frame of classical CAN with an 11-bit identifier (ISO 11898-1), all that CANopen needs.
struct CanFrame {
  static constexpr uint16_t kMaxId = 0x7ff;

  uint16_t id = 0;   ///< at most kMaxId; the lower, the more urgent
  uint8_t size = 0;  ///< bytes used of `data`, at most 8
  std::array<uint8_t, 8> data{};
  /// [ns] on the steady clock: when it was received, or when its sender handed it to the bus.
  int64_t time_ns = 0;

  std::span<const uint8_t> bytes() const { return std::span(data).first(size); }
  /// The same on the wire; when does not count.
  bool says_the_same(const CanFrame& other) const {
    return id == other.id && size == other.size && data == other.data;
  }
};

}  // namespace edgepose
