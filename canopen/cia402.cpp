#include "canopen/cia402.h"

namespace edgepose {

const char* name_of(DriveState state) {
  switch (state) {
    case DriveState::kUnknown:
      return "no state of CiA 402";
    case DriveState::kNotReady:
      return "not ready to switch on";
    case DriveState::kSwitchOnDisabled:
      return "switch on disabled";
    case DriveState::kReadyToSwitchOn:
      return "ready to switch on";
    case DriveState::kSwitchedOn:
      return "switched on";
    case DriveState::kOperationEnabled:
      return "operation enabled";
    case DriveState::kQuickStopActive:
      return "quick stop active";
    case DriveState::kFaultReactionActive:
      return "fault reaction active";
    case DriveState::kFault:
      return "fault";
  }
  return "unknown";
}

DriveState state_of(uint16_t statusword) {
  switch (statusword & 0x4f) {
    case 0x00:
      return DriveState::kNotReady;
    case 0x40:
      return DriveState::kSwitchOnDisabled;
    case 0x0f:
      return DriveState::kFaultReactionActive;
    case 0x08:
      return DriveState::kFault;
  }
  switch (statusword & 0x6f) {
    case 0x21:
      return DriveState::kReadyToSwitchOn;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kOperationEnabled;
    case 0x07:
      return DriveState::kQuickStopActive;
  }
  return DriveState::kUnknown;
}

uint16_t state_bits(DriveState state) {
  switch (state) {
    case DriveState::kUnknown:
    case DriveState::kNotReady:
      return 0x00;
    case DriveState::kSwitchOnDisabled:
      return 0x40;
    case DriveState::kReadyToSwitchOn:
      return 0x21;
    case DriveState::kSwitchedOn:
      return 0x23;
    case DriveState::kOperationEnabled:
      return 0x27;
    case DriveState::kQuickStopActive:
      return 0x07;
    case DriveState::kFaultReactionActive:
      return 0x0f;
    case DriveState::kFault:
      return 0x08;
  }
  return 0x00;
}

uint16_t controlword_towards_enabled(DriveState state) {
  switch (state) {
    case DriveState::kSwitchOnDisabled:
      return controlword::kShutdown;
    case DriveState::kReadyToSwitchOn:
      return controlword::kSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      return controlword::kEnableOperation;
    case DriveState::kFault:
      return controlword::kFaultReset;
    default:
      return controlword::kDisableVoltage;
  }
}

DriveState next_state_towards_enabled(DriveState state) {
  switch (state) {
    case DriveState::kSwitchOnDisabled:
      return DriveState::kReadyToSwitchOn;
    case DriveState::kReadyToSwitchOn:
      return DriveState::kSwitchedOn;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      return DriveState::kOperationEnabled;
    case DriveState::kFaultReactionActive:
      return DriveState::kFault;
    default:
      return DriveState::kSwitchOnDisabled;
  }
}

DriveState after_controlword(DriveState state, uint16_t word, uint16_t previous_word) {
  if (state == DriveState::kFault) {
    const bool edge = (word & 0x80) && !(previous_word & 0x80);
    return edge ? DriveState::kSwitchOnDisabled : state;  // 15
  }
  if (state == DriveState::kFaultReactionActive || state == DriveState::kNotReady ||
      state == DriveState::kUnknown)
    return state;
  if (word & 0x80) return state;
  if (!(word & 0x02)) return DriveState::kSwitchOnDisabled;  // disable voltage: 7, 9, 10, 12
  if (!(word & 0x04)) {                                      // quick stop: 7, 10, 11
    const bool powered = state == DriveState::kOperationEnabled || state == DriveState::kQuickStopActive;
    return powered ? DriveState::kQuickStopActive : DriveState::kSwitchOnDisabled;
  }
  if (state == DriveState::kQuickStopActive) return state;
  if (!(word & 0x01)) return DriveState::kReadyToSwitchOn;   // shutdown: 2, 6, 8
  if (state == DriveState::kSwitchOnDisabled) return state;  // shutdown must come first
  if (!(word & 0x08)) return DriveState::kSwitchedOn;        // 3, 5
  return DriveState::kOperationEnabled;                      // 4, or 3 and 4 at once
}

}  // namespace edgepose
