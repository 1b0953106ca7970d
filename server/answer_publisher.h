#pragma once
#include <memory>
#include <optional>

#include "edgepose_lcm/service_status_t.hpp"
#include "messaging/lcm_publisher.h"
#include "server/answer_messages.h"

namespace edgepose {

/// Sends what the daemon has to say; signed, where there is a key. Not thread-safe, but for publish_status().
class AnswerPublisher {
 public:
  AnswerPublisher(const UdpmAddress& address, const std::optional<SecretKey>& key);

  /// Fills in send_utime and the signature. Returns the time of sending [us]; 0 if the system refused it.
  int64_t publish(edgepose_lcm::pose_estimates_t& poses, edgepose_lcm::drill_targets_t& targets);
  bool publish_status(edgepose_lcm::service_status_t& status);

 private:
  template <class Message>
  bool send(const std::string& channel, const Message& message);

  LcmPublisher publisher_;
  std::optional<MessageSigner> signer_;
};

}  // namespace edgepose
