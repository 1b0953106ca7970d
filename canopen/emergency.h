#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "bus/can_frame.h"

namespace edgepose {

/// Codes that our drive sends (CiA 301, table 26; CiA 402-2).
namespace emergency_code {
inline constexpr uint16_t kNone = 0x0000, kOverTemperature = 0x4210, kNodeGuarding = 0x8130,
                          kRpdoTimeout = 0x8250, kFollowingError = 0x8611, kSyncMissing = 0x8700;
}

/// An emergency object (EMCY; CiA 301, 7.2.7). Code 0: the error is gone.
struct Emergency {
  uint16_t code = 0;
  uint8_t error_register = 0;  ///< object 1001
  std::array<uint8_t, 5> manufacturer{};
};

CanFrame emergency_frame(int node, const Emergency& emergency, int64_t now_ns);
/// None if the frame is no EMCY of a node.
std::optional<Emergency> decode_emergency(const CanFrame& frame);

/// The standards' name of a code: the exact one or its class. Never empty.
const char* cause_of(uint16_t code);
/// "0x8611 (following error)".
std::string text_of(const Emergency& emergency);

}  // namespace edgepose
