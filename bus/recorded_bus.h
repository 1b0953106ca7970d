#pragma once
#include <memory>
#include <utility>

#include "bus/can_bus.h"
#include "common/spsc_ring.h"

namespace edgepose {

/// Any bus, and a copy of what was sent and received on it for another thread, which may take its time to
/// write it (bus/pcap_writer.h): a disk must never hold up a control loop.
class RecordedBus : public CanBus {
 public:
  /// `record` must live longer.
  RecordedBus(std::unique_ptr<CanBus> bus, SpscRing<CanFrame>& record)
      : bus_(std::move(bus)), record_(record) {}

  SendResult send(const CanFrame& frame) override {
    const SendResult result = bus_->send(frame);
    if (result == SendResult::kSent) record_.push(frame);
    return result;
  }
  Received receive(int64_t deadline_ns) override {
    const Received received = bus_->receive(deadline_ns);
    if (received.kind == Received::Kind::kFrame) record_.push(received.frame);
    return received;
  }
  int descriptor() const override { return bus_->descriptor(); }
  BusCounters counters() const override { return bus_->counters(); }

 private:
  std::unique_ptr<CanBus> bus_;
  SpscRing<CanFrame>& record_;
};

}  // namespace edgepose
