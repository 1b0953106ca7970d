#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "messaging/authentication.h"
#include "messaging/checked_decode.h"
#include "messaging/udpm_assembly.h"

namespace edgepose {

/// Decides which messages of the service are believed. Not thread-safe.
class AnswerJudge {
 public:
  /// Without a key nothing is verified: any program on the network may have sent what is taken then.
  /// `max_age`: [s] since it was sent, and since the frame was taken; older
  /// messages are refused if there is a key.
  AnswerJudge(const std::optional<SecretKey>& key, double max_age);

  /// Decodes it. False, and counted, if it is not to be believed: malformed, a number that is none, unsigned,
  /// altered, replayed or old. `now_utime`: [us] since 1970, UTC.
  bool take(const ReceivedMessage& message, int64_t now_utime, edgepose_lcm::pose_estimates_t& answer);
  bool take(const ReceivedMessage& message, int64_t now_utime, edgepose_lcm::drill_targets_t& targets);
  /// A status is never signed.
  bool take(const ReceivedMessage& message, edgepose_lcm::service_status_t& status);

  bool verifies() const { return verifier_.has_value(); }
  const std::map<std::string, uint64_t>& refused() const { return refused_; }  ///< by cause

 private:
  template <class Message>
  bool take_signed(const ReceivedMessage& message, int64_t now_utime, Message& decoded);
  bool refuse(const std::string& cause);

  std::optional<MessageVerifier> verifier_;
  double max_age_;
  std::map<std::string, uint64_t> refused_;
};

}  // namespace edgepose
