#include "bus/unix_bus.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "bus/frame_record.h"
#include "bus/steady_clock.h"
#include "bus/unix_address.h"
#include "common/error.h"

namespace edgepose {

UnixBus::UnixBus(const std::filesystem::path& path) {
  const UnixAddress address = unix_address(path);
  socket_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ >= 0 && connect(socket_, address.get(), sizeof(address.value)) == 0) return;
  const int cause = errno;
  if (socket_ >= 0) close(socket_);
  throw InputError::at("bus unix:" + path.string(), "a bus that can be joined", std::strerror(cause),
                       "start what offers it (edgepose-sim) first");
}

UnixBus::~UnixBus() { close(socket_); }

SendResult UnixBus::send(const CanFrame& frame) {
  const FrameRecord record = to_record(frame);
  ssize_t sent = -1;
  while (!down_ && (sent = ::send(socket_, record.data(), record.size(), MSG_NOSIGNAL)) < 0 &&
         errno == EINTR) {
  }
  if (sent == static_cast<ssize_t>(record.size())) {
    ++counters_.sent;
    return SendResult::kSent;
  }
  if (!down_ && (errno == EAGAIN || errno == ENOBUFS)) {
    ++counters_.no_room;
    return SendResult::kNoRoom;
  }
  ++counters_.not_sent;
  return SendResult::kDown;
}

Received UnixBus::receive(int64_t deadline_ns) {
  std::array<uint8_t, 2 * kFrameRecordBytes> packet;
  while (!down_) {
    const ssize_t got = recv(socket_, packet.data(), packet.size(), MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) {
      if (!wait_for_input(socket_, deadline_ns)) return {};
      continue;
    }
    if (got <= 0) {
      down_ = true;
      ++counters_.events;
      return {.kind = Received::Kind::kEvent, .event = BusEvent::kDown, .frame = {}};
    }
    Received received = from_record(std::span(packet).first(static_cast<size_t>(got)));
    if (received.kind == Received::Kind::kNothing) {
      ++counters_.not_decoded;
      continue;
    }
    ++(received.kind == Received::Kind::kFrame ? counters_.received : counters_.events);
    received.frame.time_ns = steady_ns();
    return received;
  }
  wait_for_input(-1, deadline_ns);
  return {};
}

}  // namespace edgepose
