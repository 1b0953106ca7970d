#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>

#include "client/service/clock.h"
#include "messaging/udpm_assembly.h"

namespace edgepose {

/// A message and when it had come.
struct TimedMessage {
  int64_t receive_utime = 0;  ///< [us] since 1970, UTC
  ReceivedMessage message;
};

/// Between a receiver, which must not wait, and whoever works on its messages. Bounded by bytes; what comes
/// when it is full is dropped and counted. Safe from any thread.
class MessageQueue {
 public:
  explicit MessageQueue(size_t max_bytes) : max_bytes_(max_bytes) {}

  /// False if there was no room.
  bool push(TimedMessage&& message);
  /// The oldest; waits for one until `deadline`, a stop or close(). Nothing then.
  std::optional<TimedMessage> pop(const std::stop_token& stop, SteadyTime deadline);
  /// Nothing more will come; what is in it can still be taken.
  void close();

  bool is_closed() const;
  uint64_t dropped() const;
  size_t bytes() const;

  /// [bytes] that a message counts, however short it is.
  static size_t cost(const ReceivedMessage& message);

 private:
  const size_t max_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<TimedMessage> messages_;  // guarded by mutex_, as all below
  size_t bytes_ = 0;
  uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace edgepose
