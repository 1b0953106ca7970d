#pragma once
#include <algorithm>

#include "bus/can_bus.h"
#include "fuzz/input_check.h"

namespace edgepose {

/// A bus that gives the input's frames, 10 bytes each (identifier, length, data), and takes every frame.
class SinkBus : public CanBus {
 public:
  SinkBus(const uint8_t* data, size_t size) : data_(data), size_(size) {}

  SendResult send(const CanFrame& frame) override {
    must_hold(frame.size <= 8 && frame.id <= CanFrame::kMaxId);
    return SendResult::kSent;
  }
  Received receive(int64_t) override {
    if (pause_ || size_ < kBytes) {
      pause_ = false;
      return {};
    }
    Received received{.kind = Received::Kind::kFrame, .event = BusEvent::kNone, .frame = {}};
    received.frame.id = static_cast<uint16_t>((data_[0] | data_[1] << 8) & CanFrame::kMaxId);
    received.frame.size = std::min<uint8_t>(8, data_[1] >> 4);
    pause_ = data_[1] & 8;  // the rest comes in the next cycle
    for (size_t i = 0; i < 8; ++i) received.frame.data[i] = data_[2 + i];
    data_ += kBytes;
    size_ -= kBytes;
    return received;
  }
  bool is_empty() const { return size_ < kBytes; }

 private:
  static constexpr size_t kBytes = 10;
  const uint8_t* data_;
  size_t size_;
  bool pause_ = false;
};

}  // namespace edgepose
