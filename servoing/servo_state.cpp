#include "servoing/servo_state.h"

#include <array>

namespace edgepose {
namespace {

using Row = std::array<std::optional<ServoState>, kServoEvents>;

}  // namespace

std::optional<ServoState> transition(ServoState state, ServoEvent event) {
  using enum ServoState;
  constexpr std::nullopt_t none = std::nullopt;
  static const std::array<Row, kServoStates> kTable = {{
      {kArmed, none, kIdle, kIdle, none, none, kFault},           // idle
      {none, kApproaching, kStopped, kIdle, none, none, kFault},  // armed
      {none, none, kStopped, none, kAxial, none, kFault},         // approaching
      {none, none, kStopped, none, none, kConverged, kFault},     // axial
      {none, none, kStopped, kIdle, none, none, kFault},          // converged
      {none, none, kStopped, kIdle, none, none, kFault},          // stopped
      {none, none, kFault, kIdle, none, none, kFault},            // fault
  }};
  return kTable[static_cast<size_t>(state)][static_cast<size_t>(event)];
}

const char* state_name(ServoState state) {
  static constexpr std::array<const char*, kServoStates> kNames = {
      "idle", "armed", "approaching", "axial", "converged", "stopped", "fault"};
  return kNames[static_cast<size_t>(state)];
}

const char* event_name(ServoEvent event) {
  static constexpr std::array<const char*, kServoEvents> kNames = {
      "arm", "go", "stop", "reset", "standoff reached", "touched", "failed"};
  return kNames[static_cast<size_t>(event)];
}

const char* fault_name(FaultCause cause) {
  static constexpr std::array<const char*, 10> kNames = {
      "none",        "poses lost", "half a turn away", "singularity or out of reach",
      "joint limit", "timeout",    "following error",  "bad state of the arm",
      "bus",         "drive"};
  return kNames[static_cast<size_t>(cause)];
}

}  // namespace edgepose
