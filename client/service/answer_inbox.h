#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "client/service/clock.h"
#include "messaging/udpm_assembly.h"

namespace edgepose {

/// Waits for the service's answer to one frame after the other. Safe from any thread.
class AnswerInbox {
 public:
  /// To be called before the frame is sent: an answer may come at once.
  void expect(const std::string& camera, int64_t sequence);

  /// Looks whether it is the one that is waited for. Quick.
  void see(const ReceivedMessage& message);

  /// [s] from expect() until it came; nothing if it has not by then, or a stop was asked for.
  std::optional<double> wait(const std::stop_token& stop, SteadyTime deadline);

  uint64_t malformed() const;  ///< messages on the answers' channel that are none

 private:
  mutable std::mutex mutex_;
  std::condition_variable_any came_;
  std::string camera_;  // guarded by mutex_, as all below
  int64_t sequence_ = 0;
  SteadyTime since_;
  std::optional<double> latency_;
  uint64_t malformed_ = 0;
};

}  // namespace edgepose
