#include "bus/socket_can_bus.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "bus/steady_clock.h"
#include "common/error.h"

namespace edgepose {
namespace {

template <class Value>
bool set_option(int socket, int level, int option, const Value& value) {
  return setsockopt(socket, level, option, &value, sizeof(value)) == 0;
}

/// Index of the interface. Throws InputError unless it is a CAN interface that is up.
int can_interface(int socket, const std::string& name) {
  ifreq request{};
  if (name.empty() || name.size() >= IFNAMSIZ)
    throw InputError::at("bus " + name, "the name of a CAN interface",
                         std::to_string(name.size()) + " characters");
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(socket, SIOCGIFHWADDR, &request) != 0)
    throw InputError::at("bus " + name, "a CAN interface", "no interface of this name", "ip link lists them");
  if (request.ifr_hwaddr.sa_family != ARPHRD_CAN)
    throw InputError::at("bus " + name, "a CAN interface", "an interface of another kind");
  if (ioctl(socket, SIOCGIFFLAGS, &request) != 0 || !(request.ifr_flags & IFF_UP))
    throw InputError::at("bus " + name, "a CAN interface that is up", "one that is down",
                         "ip link set " + name + " up type can bitrate 1000000");
  if (ioctl(socket, SIOCGIFINDEX, &request) != 0)
    throw InputError::at("bus " + name, "a CAN interface", std::strerror(errno));
  return request.ifr_ifindex;
}

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

SocketCanBus::SocketCanBus(const std::string& interface, const SocketCanOptions& options)
    : socket_(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW)) {
  if (socket_ < 0)
    throw InputError::at("bus " + interface, "a CAN socket", std::strerror(errno),
                         "the kernel needs the modules can and can-raw");
  try {
    configure(interface, options);
  } catch (...) {
    close(socket_);
    throw;
  }
}

SocketCanBus::~SocketCanBus() { close(socket_); }

void SocketCanBus::configure(const std::string& interface, const SocketCanOptions& options) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = can_interface(socket_, interface);
  for (const uint16_t id : options.ids) received_ids_.set(id & CAN_SFF_MASK);
  for (const uint16_t id : options.confirm) confirmed_ids_.set(id & CAN_SFF_MASK);
  if (options.ids.empty())
    received_ids_.set();
  else
    filter(interface, received_ids_ | confirmed_ids_);  // own frames pass the same filters
  const can_err_mask_t errors = CAN_ERR_MASK;           // off by default
  if (!set_option(socket_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors))
    throw InputError::at("bus " + interface, "error frames", std::strerror(errno));
  if (confirmed_ids_.any() && !set_option(socket_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1))
    throw InputError::at("bus " + interface, "own frames confirmed", std::strerror(errno));
  set_option(socket_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1);  // to be counted
  set_option(socket_, SOL_SOCKET, SO_RXQ_OVFL, 1);
  set_option(socket_, SOL_SOCKET, SO_TIMESTAMPING,
             static_cast<int>(SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE));
  if (!set_option(socket_, SOL_SOCKET, SO_RCVBUFFORCE, options.receive_buffer_bytes))
    set_option(socket_, SOL_SOCKET, SO_RCVBUF, options.receive_buffer_bytes);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    throw InputError::at("bus " + interface, "a CAN interface to bind to", std::strerror(errno));
}

void SocketCanBus::filter(const std::string& interface, const IdSet& ids) {
  // This mask the kernel looks up in a table, whatever the number of filters.
  std::vector<can_filter> filters;
  for (size_t id = 0; id < ids.size(); ++id)
    if (ids[id])
      filters.push_back(
          {.can_id = static_cast<canid_t>(id), .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG});
  const auto bytes = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
  if (setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) != 0)
    throw InputError::at("bus " + interface, "at most 512 identifiers to filter for",
                         std::to_string(filters.size()));
}

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
