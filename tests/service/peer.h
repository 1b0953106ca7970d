#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>

#include "messaging/checked_decode.h"
#include "messaging/depth_message.h"
#include "messaging/lcm_publisher.h"
#include "messaging/udpm_receiver.h"

namespace edgepose::test {

/// What a camera and a listener of the service are, in one: sends frames, receives answers.
class Peer {
 public:
  using Clock = std::chrono::steady_clock;
  struct Answer {
    edgepose_lcm::pose_estimates_t poses;
    std::vector<std::byte> bytes;
    Clock::time_point received;
  };

  explicit Peer(const std::string& url = kDefaultLcmUrl);

  /// Sends it as taken now. Returns its sequence number.
  int64_t send(const DepthFrame& frame, DepthEncoding encoding = DepthEncoding::kRvl);
  /// Sends it as it is.
  void send_as_is(const edgepose_lcm::depth_frame_t& message);
  void send_bytes(const std::string& channel, std::span<const std::byte> bytes);

  /// The answer to that frame; nothing if none has come after so many seconds.
  std::optional<Answer> answer_to(int64_t sequence, double seconds = 20);
  std::optional<edgepose_lcm::drill_targets_t> targets_of(int64_t sequence, double seconds = 20);
  std::map<int64_t, Answer> answers() const;
  Clock::time_point sent_at(int64_t sequence) const;
  void forget();

 private:
  void take(ReceivedMessage&& message);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int64_t, Answer> answers_;
  std::map<int64_t, edgepose_lcm::drill_targets_t> targets_;
  std::map<int64_t, Clock::time_point> sent_;
  int64_t sequence_;
  LcmPublisher publisher_;
  UdpmReceiver receiver_;
};

int64_t utime_now();

}  // namespace edgepose::test
