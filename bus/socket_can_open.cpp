// How a CAN interface is opened: its checks, filters and options.
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

#include <cerrno>
#include <cstring>

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

}  // namespace edgepose
