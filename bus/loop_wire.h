#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bus/can_bus.h"

namespace edgepose {

/// A wire in memory: what one port sends, all others receive, in order and at once. Faults can be put on it.
class LoopWire {
 public:
  class Port : public CanBus {
   public:
    explicit Port(LoopWire& wire) : wire_(wire) { waiting_.reserve(1 << 14); }

    SendResult send(const CanFrame& frame) override {
      if (answer != SendResult::kSent) {
        ++refused;
        return answer;
      }
      ++counters_.sent;
      wire_.carry(*this, frame);
      return SendResult::kSent;
    }
    Received receive(int64_t) override {
      if (at_ == waiting_.size()) {
        waiting_.clear();
        at_ = 0;
        return {};
      }
      ++counters_.received;
      return waiting_[at_++];
    }
    /// As if so many own frames still waited in the interface's queue.
    void leave_unconfirmed(uint64_t frames) { counters_.unconfirmed = frames; }
    void put(const Received& received) { waiting_.push_back(received); }

    SendResult answer = SendResult::kSent;  ///< what send() says; refused frames go nowhere
    int refused = 0;

   private:
    LoopWire& wire_;
    std::vector<Received> waiting_;
    size_t at_ = 0;
  };

  LoopWire() { trace.reserve(1 << 18); }

  Port& port() {
    ports_.push_back(std::make_unique<Port>(*this));
    return *ports_.back();
  }
  void carry(const Port& from, const CanFrame& frame) {
    if (drop && drop(frame)) return;
    trace.push_back(frame);
    for (const auto& port : ports_)
      if (port.get() != &from)
        port->put({.kind = Received::Kind::kFrame, .event = BusEvent::kNone, .frame = frame});
  }
  void tell(Port& port, BusEvent event) {
    port.put({.kind = Received::Kind::kEvent, .event = event, .frame = {}});
  }

  std::function<bool(const CanFrame&)> drop;  ///< frames that are lost
  std::vector<CanFrame> trace;                ///< everything that was carried

 private:
  std::vector<std::unique_ptr<Port>> ports_;
};

}  // namespace edgepose
