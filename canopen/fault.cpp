#include "canopen/fault.h"

#include <cstdio>

#include "canopen/emergency.h"

namespace edgepose {
namespace {

std::string hex(uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof(text), "0x%04x", value);
  return text;
}

std::string statusword_text(uint32_t word) {
  return name_of(state_of(static_cast<uint16_t>(word))) + std::string(" (statusword ") + hex(word) + ")";
}

std::string details(const Fault& fault) {
  const std::string count = std::to_string(fault.found);
  switch (fault.kind) {
    case FaultKind::kLostState:
      return "no TPDO1 for " + count + " cycles";
    case FaultKind::kNoRoom:
      return "no frame was taken for " + count + " cycles";
    case FaultKind::kFlooded:
      return "more than " + count + " frames a cycle";
    case FaultKind::kStuck:
      return statusword_text(fault.found) + " and position stay although the target moves";
    case FaultKind::kNotOperational:
      return std::string("expected operational, found ") + name_of(fault.nmt);
    case FaultKind::kEmergency:
      return text_of(Emergency{static_cast<uint16_t>(fault.found), 0, {}});
    case FaultKind::kTransition:
    case FaultKind::kUnexpectedState:
      return std::string("expected ") + name_of(fault.expected) + ", found " + statusword_text(fault.found);
    case FaultKind::kFollowingError:
      return statusword_text(fault.found);
    default:
      return "";
  }
}

}  // namespace

const char* name_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::kNone:
      return "none";
    case FaultKind::kStopRequested:
      return "stop requested";
    case FaultKind::kSetUp:
      return "set-up failed";
    case FaultKind::kBusOff:
      return "bus-off";
    case FaultKind::kBusDown:
      return "bus down";
    case FaultKind::kNoRoom:
      return "no room on the bus";
    case FaultKind::kFlooded:
      return "bus flooded";
    case FaultKind::kOverrun:
      return "cycle overrun";
    case FaultKind::kLostState:
      return "state lost";
    case FaultKind::kHeartbeat:
      return "heartbeat lost";
    case FaultKind::kNotOperational:
      return "not operational";
    case FaultKind::kRebooted:
      return "drive rebooted";
    case FaultKind::kEmergency:
      return "EMCY";
    case FaultKind::kDuplicateNode:
      return "two nodes of one number";
    case FaultKind::kTransition:
      return "transition timed out";
    case FaultKind::kUnexpectedState:
      return "unexpected state";
    case FaultKind::kStuck:
      return "state stuck";
    case FaultKind::kFollowingError:
      return "following error";
    case FaultKind::kBadSetPoint:
      return "bad set point";
  }
  return "unknown";
}

std::string text_of(const Fault& fault) {
  std::string text = fault.node ? "node " + std::to_string(fault.node) + ": " : "";
  text += name_of(fault.kind);
  if (const std::string more = details(fault); !more.empty()) text += ": " + more;
  if (fault.after_ns > 0) text += " after " + std::to_string(fault.after_ns / 1'000'000) + " ms";
  if (fault.kind == FaultKind::kRebooted) text += "; homing required";
  return text;
}

}  // namespace edgepose
