#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "bus/frame_record.h"

namespace edgepose {

/// What waits for a wire of a given rate. Each sender's frames keep their order; of the senders' first ones
/// the lowest identifier goes, as on a CAN bus, so that a flood of urgent frames starves all others. Time
/// comes in with each call. One thread.
template <class Sender>
class Arbitration {
 public:
  struct Waiting {
    uint32_t id;
    Sender from;
    FrameRecord record;
  };

  /// `rate`: [frames/s] > 0; so many may go at once after a pause: `burst`. Of a sender for which more than
  /// `capacity` wait, the newest is lost.
  Arbitration(double rate, size_t burst, size_t capacity)
      : rate_(rate), burst_(static_cast<double>(burst)), capacity_(capacity), credit_(burst_) {}

  /// False if it was lost.
  bool put(uint32_t id, const Sender& from, const FrameRecord& record) {
    std::deque<Waiting>& queue = queues_[from];
    if (queue.size() >= capacity_) return false;
    queue.push_back({id, from, record});
    return true;
  }
  /// The next frame that the wire has time for by `now_ns`.
  std::optional<Waiting> take(int64_t now_ns) {
    credit_ = std::min(burst_, credit_ + 1e-9 * static_cast<double>(now_ns - last_ns_) * rate_);
    last_ns_ = now_ns;
    if (queues_.empty() || credit_ < 1) return std::nullopt;
    const auto most = std::min_element(queues_.begin(), queues_.end(), [](const auto& a, const auto& b) {
      return a.second.front().id < b.second.front().id;
    });
    credit_ -= 1;
    const Waiting next = most->second.front();
    most->second.pop_front();
    if (most->second.empty()) queues_.erase(most);
    return next;
  }
  bool empty() const { return queues_.empty(); }
  int64_t ns_a_frame() const { return static_cast<int64_t>(1e9 / rate_); }

 private:
  const double rate_, burst_;
  const size_t capacity_;
  std::map<Sender, std::deque<Waiting>> queues_;  // none is empty
  double credit_;
  int64_t last_ns_ = 0;
};

}  // namespace edgepose
