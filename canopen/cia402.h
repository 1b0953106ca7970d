#pragma once
#include <cstdint>

namespace edgepose {

/// The states of a drive (CiA 402-2, figure "power drive system finite state automaton").
enum class DriveState : uint8_t {
  kUnknown,  ///< a statusword that is none of the standard's
  kNotReady,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};

/// The standard's name: "operation enabled".
const char* name_of(DriveState state);
/// By the standard's masks: 4F for not ready, switch on disabled and the faults, 6F for the others.
DriveState state_of(uint16_t statusword);
/// Bits 0-3, 5 and 6 of the statusword in a state.
uint16_t state_bits(DriveState state);

namespace statusword {
inline constexpr uint16_t kVoltageEnabled = 1 << 4, kWarning = 1 << 7, kRemote = 1 << 9,
                          kTargetReached = 1 << 10, kInternalLimit = 1 << 11;
/// In mode 8 (cyclic synchronous position).
inline constexpr uint16_t kFollowsCommand = 1 << 12, kFollowingError = 1 << 13;
}  // namespace statusword

namespace controlword {
inline constexpr uint16_t kDisableVoltage = 0x00, kQuickStop = 0x02, kShutdown = 0x06, kSwitchOn = 0x07,
                          kEnableOperation = 0x0f, kFaultReset = 0x80;
}

inline constexpr int8_t kCyclicSynchronousPosition = 8;

/// The controlword that leads one state on towards operation enabled; kDisableVoltage where there is no way
/// but back (quick stop active), kFaultReset in a fault.
uint16_t controlword_towards_enabled(DriveState state);
/// The state that it leads to.
DriveState next_state_towards_enabled(DriveState state);

/// A drive's part: where `word` leads from `state` (transitions 2-12, 15; 16, out of a quick stop straight
/// back into operation, is not offered: CiA 402-2 advises against it). Faults are reset by a rising edge of
/// bit 7.
DriveState after_controlword(DriveState state, uint16_t word, uint16_t previous_word);

}  // namespace edgepose
