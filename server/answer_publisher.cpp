#include "server/answer_publisher.h"

#include "daemon/clock.h"
#include "daemon/log.h"
#include "messaging/channels.h"
#include "messaging/checked_decode.h"

namespace edgepose {

AnswerPublisher::AnswerPublisher(const UdpmAddress& address, const std::optional<SecretKey>& key)
    : publisher_(address) {
  if (key) signer_.emplace(*key, utime_now());
}

int64_t AnswerPublisher::publish(edgepose_lcm::pose_estimates_t& poses,
                                 edgepose_lcm::drill_targets_t& targets) {
  poses.send_utime = targets.send_utime = utime_now();
  const bool sent = send(channels::kPoses, poses);
  return send(channels::kDrillTargets, targets) && sent ? poses.send_utime : 0;
}

bool AnswerPublisher::publish_status(edgepose_lcm::service_status_t& status) {
  status.send_utime = utime_now();
  return publisher_.publish(channels::kStatus, encode(status));
}

template <class Message>
bool AnswerPublisher::send(const std::string& channel, const Message& message) {
  std::vector<std::byte> bytes = encode(message);
  // What our own receivers would refuse is not sent.
  if (const std::string fault = check_lengths(bytes, &message); !fault.empty()) {
    log_limited(LogLevel::kError, "answer_not_sent", channel, {{"reason", fault}});
    return false;
  }
  if (signer_) signer_->sign(channel, bytes);
  return publisher_.publish(channel, bytes);
}

}  // namespace edgepose
