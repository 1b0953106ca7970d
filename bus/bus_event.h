#pragma once
#include <array>
#include <cstdint>

namespace edgepose {

/// What happens to a bus, as against on it. SocketCAN tells it with error frames (linux/can/error.h).
enum class BusEvent : uint8_t {
  kNone,
  kBusOff,        ///< the controller has left the bus after 256 transmit errors; an operator must restart it
  kErrorPassive,  ///< 128 errors: it may no longer signal errors of others
  kErrorWarning,  ///< 96 errors
  kErrorActive,   ///< back to normal
  kControllerOverrun,  ///< the controller's own buffer has overflowed: frames were lost
  kTransmitTimeout,
  kLostArbitration,
  kProtocolViolation,
  kTransceiver,    ///< wires broken or shorted
  kNoAcknowledge,  ///< nobody else on the bus
  kBusError,
  kRestarted,  ///< the controller is on the bus again after bus-off
  kDown,       ///< link down, interface deleted, hub gone: nothing can be sent any more
  kEnd,        ///< a replay has no more frames
};

/// As it is written in messages: "bus-off", "error passive", ...
const char* name_of(BusEvent event);

/// What an error frame says: `error_class` is the lower 29 bits of its identifier. The gravest if several.
BusEvent bus_event_of(uint32_t error_class, const std::array<uint8_t, 8>& data);

}  // namespace edgepose
