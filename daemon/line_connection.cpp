#include "daemon/line_connection.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace edgepose {

LineConnection::~LineConnection() { close(descriptor_); }

bool LineConnection::receive() {
  std::array<char, 16384> buffer;
  const ssize_t got = recv(descriptor_, buffer.data(), buffer.size(), 0);
  if (got < 0) return errno == EAGAIN || errno == EINTR;
  if (got == 0) {
    ended_ = true;
    return true;
  }
  in_.append(buffer.data(), static_cast<size_t>(got));
  const size_t line_end = in_.find('\n');
  // A line that comes byte by byte is silence.
  if (line_end != std::string::npos) last_heard = std::chrono::steady_clock::now();
  too_long_ = std::min(line_end, in_.size()) > kMaxLine;
  return !too_long_;
}

std::optional<std::string> LineConnection::next_line() {
  const size_t end = in_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = in_.substr(0, end);
  in_.erase(0, end + 1);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

bool LineConnection::queue(const std::string& line) {
  if (out_.size() + line.size() > kMaxUnsent) return false;
  out_ += line;
  out_ += '\n';
  return true;
}

bool LineConnection::send() {
  while (!out_.empty()) {
    const ssize_t sent = ::send(descriptor_, out_.data(), out_.size(), MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    out_.erase(0, static_cast<size_t>(sent));
    if (out_.empty()) last_heard = std::chrono::steady_clock::now();
  }
  return true;
}

}  // namespace edgepose
