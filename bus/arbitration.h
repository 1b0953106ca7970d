#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "bus/frame_record.h"

namespace edgepose {

/// What waits for a wire of a given rate: the lowest identifier goes first, as on a CAN bus, so that a flood
/// of urgent frames starves all others instead of delaying them. Time comes in with each call. One thread.
template <class Sender>
class Arbitration {
 public:
  struct Waiting {
    Sender from;
    FrameRecord record;
  };

  /// `rate`: [frames/s] > 0; so many may go at once after a pause: `burst`. Of more than `capacity` that wait
  /// the least urgent is lost.
  Arbitration(double rate, size_t burst, size_t capacity)
      : rate_(rate), burst_(static_cast<double>(burst)), capacity_(capacity), credit_(burst_) {}

  /// False if this or another frame was lost.
  bool put(uint32_t id, const Sender& from, const FrameRecord& record) {
    waiting_[id].push_back({from, record});
    if (++count_ <= capacity_) return true;
    auto& least = std::prev(waiting_.end())->second;
    least.pop_back();
    if (least.empty()) waiting_.erase(std::prev(waiting_.end()));
    --count_;
    return false;
  }
  /// The next frame that the wire has time for by `now_ns`.
  std::optional<Waiting> take(int64_t now_ns) {
    credit_ = std::min(burst_, credit_ + 1e-9 * static_cast<double>(now_ns - last_ns_) * rate_);
    last_ns_ = now_ns;
    if (waiting_.empty() || credit_ < 1) return std::nullopt;
    credit_ -= 1;
    auto& most = waiting_.begin()->second;
    Waiting next = most.front();
    most.pop_front();
    if (most.empty()) waiting_.erase(waiting_.begin());
    --count_;
    return next;
  }
  bool empty() const { return waiting_.empty(); }
  int64_t ns_a_frame() const { return static_cast<int64_t>(1e9 / rate_); }

 private:
  const double rate_, burst_;
  const size_t capacity_;
  std::map<uint32_t, std::deque<Waiting>> waiting_;
  size_t count_ = 0;
  double credit_;
  int64_t last_ns_ = 0;
};

}  // namespace edgepose
