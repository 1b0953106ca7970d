#pragma once
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>

#include "client/service/message_queue.h"
#include "messaging/lcm_log_writer.h"

namespace edgepose {

/// What has been recorded, and what has not.
struct RecordCounters {
  uint64_t messages = 0, bytes = 0;          ///< written; bytes of the log
  uint64_t dropped = 0;                      ///< no room in the queue: the disk is too slow
  uint64_t refused = 0;                      ///< longer than a log's record may be
  std::map<std::string, uint64_t> channels;  ///< messages of the first thousand channels
};

/// Writes messages to a log, on a thread of its own.
class Recorder {
 public:
  struct Options {
    std::set<std::string> channels;          ///< empty: all
    size_t queue_bytes = size_t{256} << 20;  ///< between the receiver and the disk
    uint64_t max_messages = 0;               ///< 0: no end
  };

  /// Throws InputError if the file cannot be made.
  Recorder(const std::filesystem::path& path, LcmLogWriter::Existing existing, const Options& options);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();

  /// Takes a message, if it is to be recorded. Quick; from any thread.
  void take(ReceivedMessage&& message);

  /// Waits until `deadline`, for a stop, for as many messages as are wanted, or for the disk to be full.
  void wait(const std::stop_token& stop, SteadyTime deadline);

  /// Writes what is in the queue and closes the log. Throws InputError if not all could be written.
  void finish();

  RecordCounters counters() const;  ///< from any thread

 private:
  void run();
  void write(const TimedMessage& message);

  const Options options_;
  MessageQueue queue_;
  LcmLogWriter writer_;  // of the thread, until it has ended
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  RecordCounters counters_;  // guarded by mutex_
  bool done_ = false;        // guarded by mutex_
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace edgepose
