#pragma once
#include <memory>
#include <utility>

#include "bus/can_bus.h"
#include "bus/pcap_writer.h"

namespace edgepose {

/// Any bus, and a record of what was sent and received on it, in the order in which its user saw it.
class TappedBus : public CanBus {
 public:
  TappedBus(std::unique_ptr<CanBus> bus, std::unique_ptr<PcapWriter> writer)
      : bus_(std::move(bus)), writer_(std::move(writer)) {}

  /// Recorded if it was sent, with the frame's own time.
  SendResult send(const CanFrame& frame) override {
    const SendResult result = bus_->send(frame);
    if (result == SendResult::kSent) writer_->write(frame);
    return result;
  }
  Received receive(int64_t deadline_ns) override {
    const Received received = bus_->receive(deadline_ns);
    if (received.kind == Received::Kind::kFrame) writer_->write(received.frame);
    return received;
  }
  int descriptor() const override { return bus_->descriptor(); }
  BusCounters counters() const override { return bus_->counters(); }
  PcapWriter& writer() { return *writer_; }

 private:
  std::unique_ptr<CanBus> bus_;
  std::unique_ptr<PcapWriter> writer_;
};

}  // namespace edgepose
