#pragma once
#include <cstdint>
#include <string>

#include "bus/bus_event.h"
#include "canopen/cia402.h"
#include "canopen/nmt.h"

namespace edgepose {

/// Why the arm was stopped. The first one latches.
enum class FaultKind : uint8_t {
  kNone,
  kStopRequested,
  kSetUp,  ///< a drive could not be set up; the master's set_up_error() says why
  kBusOff,
  kBusDown,
  kNoRoom,           ///< the bus took no frame, several cycles in a row
  kFlooded,          ///< more frames came than a cycle can take
  kOverrun,          ///< the master itself was not called for too long
  kLostState,        ///< TPDO1 stayed away
  kHeartbeat,        ///< the heartbeat stayed away
  kNotOperational,   ///< a drive has left NMT state operational
  kRebooted,         ///< a drive has booted: it must be homed
  kEmergency,        ///< a drive has sent EMCY
  kDuplicateNode,    ///< two nodes answer to one number
  kTransition,       ///< a state of CiA 402 was not reached in time
  kUnexpectedState,  ///< a drive has left operation enabled
  kStuck,            ///< a drive's state no longer changes although its target does
  kFollowingError,
  kBadSetPoint,  ///< not finite, or further away than the axis can get in a cycle
};

struct Fault {
  FaultKind kind = FaultKind::kNone;
  int node = 0;  ///< 0: none in particular
  int64_t time_ns = 0;
  /// What came: a statusword, an EMCY code, a number of cycles or frames.
  uint32_t found = 0;
  DriveState expected = DriveState::kUnknown;  ///< of kTransition and kUnexpectedState
  NmtState nmt = NmtState::kOperational;       ///< of kNotOperational
  int64_t after_ns = 0;                        ///< how long it was waited for

  explicit operator bool() const { return kind != FaultKind::kNone; }
};

/// "stop requested", "heartbeat lost", ...
const char* name_of(FaultKind kind);
/// One line: node, what was expected, what came, after how long.
std::string text_of(const Fault& fault);

}  // namespace edgepose
