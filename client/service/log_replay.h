#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "client/service/answer_inbox.h"
#include "client/service/frame_restamp.h"
#include "messaging/lcm_log.h"

namespace edgepose {

struct ReplayOptions {
  double speed = 1;  ///< times as fast as recorded; 0: each frame when the one before is answered
  std::set<std::string> channels;  ///< empty: all
  bool keep_times = false;         ///< messages as they were logged
  double timeout = 5;              ///< [s] for each answer, at speed 0
};

struct ReplayCounters {
  uint64_t sent = 0, frames = 0;          ///< messages; depth and cloud frames among them
  uint64_t answered = 0;                  ///< frames, at speed 0
  uint64_t refused = 0;                   ///< the system would not send it, or LCM has no such channel name
  uint64_t malformed = 0;                 ///< on a frames' channel, but no frame: not sent
  uint64_t beyond = 0;                    ///< frames whose number cannot be moved: not sent
  uint64_t skipped_bytes = 0;             ///< of the log that belong to no record
  bool cut_off = false;                   ///< the log ends within a record
  std::map<std::string, uint64_t> other;  ///< messages by channel that were not asked for
};

/// Sends the messages of a log at the times of their reception.
class LogReplay {
 public:
  using Publish = std::function<bool(const std::string& channel, std::span<const std::byte> message)>;

  /// `inbox` gets to know each frame before `publish` is called. Throws InputError if there is no log that
  /// can be read.
  LogReplay(const std::filesystem::path& path, ReplayOptions options, Publish publish, AnswerInbox& inbox);

  /// Until the end of the log or a stop. Throws InputError, with the channels that there are, if no message
  /// was to be sent.
  void run(const std::stop_token& stop);

  const ReplayCounters& counters() const { return counters_; }
  const std::vector<double>& latencies() const { return latencies_; }  ///< [s] at speed 0

 private:
  bool wait_for_turn(int64_t utime, const std::stop_token& stop);
  void send(LoggedMessage& message, const std::stop_token& stop);
  [[noreturn]] void fail_without_match() const;

  struct Anchor {
    SteadyTime at;
    int64_t utime;
  };
  std::filesystem::path path_;
  LcmLogReader reader_;
  ReplayOptions options_;
  Publish publish_;
  AnswerInbox& inbox_;
  FrameRestamp restamp_;
  std::optional<Anchor> anchor_;  // which moment of the log is now
  int64_t last_utime_ = 0;
  ReplayCounters counters_;
  std::vector<double> latencies_;
};

}  // namespace edgepose
