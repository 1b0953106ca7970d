#include "client/service/answer_inbox.h"

#include "messaging/channels.h"
#include "messaging/checked_decode.h"

namespace edgepose {

void AnswerInbox::expect(const std::string& camera, int64_t sequence) {
  const std::scoped_lock lock(mutex_);
  camera_ = camera;
  sequence_ = sequence;
  latency_.reset();
  since_ = std::chrono::steady_clock::now();
}

void AnswerInbox::see(const ReceivedMessage& message) {
  if (message.channel != channels::kPoses) return;
  const SteadyTime now = std::chrono::steady_clock::now();
  edgepose_lcm::pose_estimates_t answer;
  const bool sound = decode_checked(message.data(), answer).empty();
  const std::scoped_lock lock(mutex_);
  if (!sound) {
    ++malformed_;
    return;
  }
  if (latency_ || answer.camera != camera_ || answer.sequence != sequence_) return;
  latency_ = std::chrono::duration<double>(now - since_).count();
  came_.notify_all();
}

std::optional<double> AnswerInbox::wait(const std::stop_token& stop, SteadyTime deadline) {
  std::unique_lock lock(mutex_);
  came_.wait_until(lock, stop, deadline, [&] { return latency_.has_value(); });
  return latency_;
}

uint64_t AnswerInbox::malformed() const {
  const std::scoped_lock lock(mutex_);
  return malformed_;
}

}  // namespace edgepose
