#pragma once
#include <cstdint>

#include "bus/bus_event.h"
#include "bus/can_frame.h"

namespace edgepose {

enum class SendResult : uint8_t {
  kSent,
  kNoRoom,  ///< the queue is full (ENOBUFS): the frame is dropped. Never send it again: by then it is stale
  kDown,    ///< nothing can be sent: link down, interface or hub gone, bus-off
};

struct Received {
  enum class Kind : uint8_t { kNothing, kFrame, kEvent };
  Kind kind = Kind::kNothing;
  BusEvent event = BusEvent::kNone;  ///< if kEvent
  CanFrame frame;                    ///< if kFrame
};

/// Since the bus was opened.
struct BusCounters {
  uint64_t sent = 0, received = 0;
  uint64_t no_room = 0;      ///< frames that were dropped since the queue was full
  uint64_t not_sent = 0;     ///< frames that were dropped since the bus was down
  uint64_t lost = 0;         ///< frames that came but for which the system had no room
  uint64_t not_decoded = 0;  ///< extended, remote and FD frames, and what is no frame
  uint64_t events = 0;
  /// Where asked for (SocketCanOptions::confirm): own frames that were on the wire, as the interface says,
  /// and those handed over that still wait for it. As of the last receive(); none waits after link down or
  /// bus-off.
  uint64_t confirmed = 0, unconfirmed = 0;
};

/// A CAN bus as its users see it: frames out, frames and events in. Nothing here throws once it is open. A
/// backend is used by one thread at a time.
class CanBus {
 public:
  CanBus() = default;
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;
  virtual ~CanBus() = default;

  /// Hands the frame to the bus or drops it; never waits.
  virtual SendResult send(const CanFrame& frame) = 0;
  /// The next frame or event; waits for it until `deadline_ns` on the steady clock (0: not at all).
  virtual Received receive(int64_t deadline_ns) = 0;
  /// To wait on for input together with others (poll); -1 if there is none.
  virtual int descriptor() const { return -1; }
  virtual BusCounters counters() const { return counters_; }

 protected:
  BusCounters counters_;
};

}  // namespace edgepose
