#pragma once
#include <chrono>
#include <optional>
#include <string>

namespace edgepose {

/// Longest request and largest answer that waits to be taken, bytes.
inline constexpr size_t kMaxLine = 64 << 10, kMaxUnsent = 4 << 20;

/// One client: what it sent, cut into lines, and what it has not yet taken. Bounded both ways. Not
/// thread-safe.
class LineConnection {
 public:
  explicit LineConnection(int descriptor, bool over_tcp = false)
      : descriptor_(descriptor), over_tcp_(over_tcp) {}
  LineConnection(const LineConnection&) = delete;
  LineConnection& operator=(const LineConnection&) = delete;
  ~LineConnection();

  int descriptor() const { return descriptor_; }
  bool over_tcp() const { return over_tcp_; }
  /// Reads what has come. False: the client is gone, or sends a line that is too long.
  bool receive();
  /// The next whole line, without its end.
  std::optional<std::string> next_line();
  /// Queues an answer. False if the client does not take what it asked for.
  bool queue(const std::string& line);
  /// Sends what can be sent now. False: the client is gone.
  bool send();

  bool wants_to_send() const { return !out_.empty(); }
  /// Room for more requests: one at a time is worked on.
  bool wants_to_receive() const { return in_.size() <= kMaxLine && !ended_; }
  /// The client has closed its side; what it asked for is still answered.
  bool ended() const { return ended_; }
  bool too_long() const { return too_long_; }
  bool has_line() const { return in_.find('\n') != std::string::npos; }

  bool busy = false;  ///< an answer is being made
  /// When it last sent a whole line, or took all that was waiting for it.
  std::chrono::steady_clock::time_point last_heard = std::chrono::steady_clock::now();

 private:
  int descriptor_;
  bool over_tcp_;
  std::string in_, out_;
  bool ended_ = false, too_long_ = false;
};

}  // namespace edgepose
