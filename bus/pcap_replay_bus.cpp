#include "bus/pcap_replay_bus.h"

#include <algorithm>

#include "bus/steady_clock.h"

namespace edgepose {

PcapReplayBus::PcapReplayBus(const std::filesystem::path& path, Pace pace) : reader_(path), pace_(pace) {}

SendResult PcapReplayBus::send(const CanFrame&) {
  ++counters_.sent;
  return SendResult::kSent;
}

Received PcapReplayBus::receive(int64_t deadline_ns) {
  using Kind = Received::Kind;
  if (ahead_.kind == Kind::kNothing && !ended_) {
    ahead_ = reader_.next();
    counters_.not_decoded = reader_.skipped();
    if (ahead_.kind == Kind::kNothing) {
      ended_ = true;
      ++counters_.events;
      return {.kind = Kind::kEvent, .event = BusEvent::kEnd, .frame = {}};
    }
    if (!begun_ && pace_ == Pace::kRecorded) shift_ns_ = steady_ns() - ahead_.frame.time_ns;
    begun_ = true;
    ahead_.frame.time_ns += shift_ns_;
  }
  if (ended_ || pace_ == Pace::kRecorded) {
    const int64_t due = ended_ ? deadline_ns : std::min(deadline_ns, ahead_.frame.time_ns);
    wait_for_input(-1, due);
    if (ended_ || steady_ns() < ahead_.frame.time_ns) return {};
  }
  ++(ahead_.kind == Kind::kFrame ? counters_.received : counters_.events);
  Received out = ahead_;
  ahead_ = {};
  return out;
}

}  // namespace edgepose
