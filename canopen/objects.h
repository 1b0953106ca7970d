#pragma once
#include <compare>
#include <cstdint>
#include <cstdio>
#include <string>

namespace edgepose {

/// An entry of an object dictionary.
struct ObjectId {
  uint16_t index = 0;
  uint8_t sub = 0;
  bool operator==(const ObjectId&) const = default;
  auto operator<=>(const ObjectId&) const =
      default;  // NOLINT(modernize-use-nullptr): clang-tidy 14's mistake
};

/// "6041:00".
inline std::string text_of(const ObjectId& id) {
  char text[8];
  std::snprintf(text, sizeof(text), "%04X:%02X", unsigned{id.index}, unsigned{id.sub});
  return text;
}

/// The entries that master and drive speak of, by their names in CiA 301 and CiA 402.
namespace object {
inline constexpr ObjectId kDeviceType{0x1000, 0}, kErrorRegister{0x1001, 0}, kErrorCount{0x1003, 0},
    kSyncCobId{0x1005, 0}, kCyclePeriod{0x1006, 0}, kDeviceName{0x1008, 0}, kEmergencyCobId{0x1014, 0},
    kConsumerHeartbeat{0x1016, 1}, kProducerHeartbeat{0x1017, 0}, kVendor{0x1018, 1}, kProduct{0x1018, 2},
    kRevision{0x1018, 3}, kSerial{0x1018, 4}, kErrorBehaviour{0x1029, 1}, kAxisName{0x2000, 0},
    kAbortOption{0x6007, 0}, kErrorCode{0x603f, 0}, kControlword{0x6040, 0}, kStatusword{0x6041, 0},
    kQuickStopOption{0x605a, 0}, kHaltOption{0x605d, 0}, kFaultOption{0x605e, 0}, kMode{0x6060, 0},
    kModeDisplay{0x6061, 0}, kPosition{0x6064, 0}, kFollowingWindow{0x6065, 0}, kFollowingTimeout{0x6066, 0},
    kVelocity{0x606c, 0}, kTorque{0x6077, 0}, kTargetPosition{0x607a, 0}, kMinPosition{0x607d, 1},
    kMaxPosition{0x607d, 2}, kMaxVelocity{0x607f, 0}, kQuickStopDeceleration{0x6085, 0},
    kInterpolationTime{0x60c2, 1}, kInterpolationExponent{0x60c2, 2}, kFollowingError{0x60f4, 0},
    kSupportedModes{0x6502, 0};
inline constexpr uint16_t kRpdoCommunication = 0x1400, kRpdoMapping = 0x1600, kTpdoCommunication = 0x1800,
                          kTpdoMapping = 0x1a00;
}  // namespace object

}  // namespace edgepose
