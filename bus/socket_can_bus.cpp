#include "bus/socket_can_bus.h"

#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "bus/steady_clock.h"

namespace edgepose {
namespace {

/// When it was received, on the steady clock: the kernel stamps by the wall clock, which may be set in
/// between.
int64_t steady_time_of(const timespec& stamp) {
  constexpr int64_t kSecond = 1'000'000'000;
  const int64_t now = steady_ns();
  timespec wall{};
  clock_gettime(CLOCK_REALTIME, &wall);
  const int64_t age = (wall.tv_sec - stamp.tv_sec) * kSecond + wall.tv_nsec - stamp.tv_nsec;
  return age >= 0 && age < kSecond ? now - age : now;
}

}  // namespace

SendResult SocketCanBus::send(const CanFrame& frame) {
  if (is_off_) {
    ++counters_.not_sent;
    return SendResult::kDown;
  }
  can_frame wire{};
  wire.can_id = frame.id & CAN_SFF_MASK;
  wire.can_dlc = std::min<uint8_t>(frame.size, CAN_MAX_DLEN);
  std::copy_n(frame.data.begin(), wire.can_dlc, wire.data);
  ssize_t written = 0;
  do written = write(socket_, &wire, sizeof(wire));
  while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(sizeof(wire))) {
    ++counters_.sent;
    counters_.unconfirmed += confirmed_ids_[wire.can_id];
    return SendResult::kSent;
  }
  if (errno == ENOBUFS || errno == EAGAIN) {
    ++counters_.no_room;
    return SendResult::kNoRoom;
  }
  ++counters_.not_sent;  // ENETDOWN: link down; ENXIO: interface deleted
  return SendResult::kDown;
}

Received SocketCanBus::report(BusEvent event) {
  ++counters_.events;
  if (event == BusEvent::kBusOff) is_off_ = true;
  if (event == BusEvent::kRestarted || event == BusEvent::kDown) is_off_ = false;
  // What was queued is gone.
  if (event == BusEvent::kBusOff || event == BusEvent::kDown) counters_.unconfirmed = 0;
  return {.kind = Received::Kind::kEvent, .event = event, .frame = {}};
}

Received SocketCanBus::receive(int64_t deadline_ns) {
  canfd_frame wire{};
  iovec place{.iov_base = &wire, .iov_len = sizeof(wire)};
  alignas(cmsghdr) std::array<char, 256> control;
  for (;;) {
    msghdr message{};
    message.msg_iov = &place;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t got = recvmsg(socket_, &message, MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) {
      if (!wait_for_input(socket_, deadline_ns)) return {};
      continue;
    }
    // ENETDOWN: link down; ENODEV: interface deleted. The kernel says it once.
    if (got < 0) return report(BusEvent::kDown);
    int64_t time = 0;
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part; part = CMSG_NXTHDR(&message, part)) {
      if (part->cmsg_level != SOL_SOCKET) continue;
      if (part->cmsg_type ==
          SO_RXQ_OVFL) {  // counts from the beginning; seen on the frame after the loss only
        uint32_t overflows = 0;
        std::memcpy(&overflows, CMSG_DATA(part), sizeof(overflows));
        counters_.lost += overflows - overflows_;
        overflows_ = overflows;
      } else if (part->cmsg_type == SCM_TIMESTAMPING) {
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(part), sizeof(stamp));
        if (stamp.tv_sec != 0) time = steady_time_of(stamp);
      }
    }
    if (wire.can_id & CAN_ERR_FLAG) {
      std::array<uint8_t, 8> data{};
      std::copy_n(wire.data, data.size(), data.begin());
      return report(bus_event_of(wire.can_id & CAN_ERR_MASK, data));
    }
    const bool ours =
        got == CAN_MTU && wire.len <= CAN_MAX_DLEN && !(wire.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG));
    if (!ours) {
      ++counters_.not_decoded;
      continue;
    }
    if (message.msg_flags & MSG_CONFIRM) {
      const bool counts = confirmed_ids_[wire.can_id];
      counters_.confirmed += counts;
      counters_.unconfirmed -= counts && counters_.unconfirmed > 0;
      continue;
    }
    if (!received_ids_[wire.can_id]) continue;  // somebody else's, of an identifier that is only confirmed
    Received received;
    received.kind = Received::Kind::kFrame;
    received.frame.id = static_cast<uint16_t>(wire.can_id);
    received.frame.size = wire.len;
    std::copy_n(wire.data, wire.len, received.frame.data.begin());
    received.frame.time_ns = time != 0 ? time : steady_ns();
    ++counters_.received;
    return received;
  }
}

}  // namespace edgepose
