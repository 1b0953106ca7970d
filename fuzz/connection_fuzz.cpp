#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "daemon/line_connection.h"
#include "fuzz/input_check.h"

// Bytes from a client, in pieces: the lines are those that were sent, whatever the pieces.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  if (size < 1) return 0;
  const size_t piece = data[0] + 1u;
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()) != 0) return 0;
  LineConnection connection(ends[0]);
  std::string sent, heard;
  for (size_t at = 1; at < size; at += piece) {
    const size_t count = std::min(piece, size - at);
    must_hold(send(ends[1], data + at, count, MSG_NOSIGNAL) == static_cast<ssize_t>(count));
    sent.append(reinterpret_cast<const char*>(data + at), count);
    if (!connection.receive()) break;
    while (const auto line = connection.next_line()) {
      must_hold(line->find('\n') == std::string::npos && line->size() <= kMaxLine);
      heard += *line + "\n";
    }
  }
  if (sent.find('\r') == std::string::npos && size < kMaxLine)
    must_hold(sent.starts_with(heard) && sent.find('\n', heard.size()) == std::string::npos);
  close(ends[1]);
  return 0;
}
