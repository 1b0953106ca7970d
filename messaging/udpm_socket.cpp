#include "messaging/udpm_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "common/error.h"

namespace edgepose {
namespace {

std::string name_of(const UdpmAddress& address) {
  const in_addr ip{htonl(address.group)};
  char text[INET_ADDRSTRLEN] = {};
  inet_ntop(AF_INET, &ip, text, sizeof(text));
  return std::string(text) + ":" + std::to_string(address.port);
}

template <class Value>
bool set(int socket, int level, int option, const Value& value) {
  return setsockopt(socket, level, option, &value, sizeof(value)) == 0;
}

}  // namespace

int receive_buffer_of(int socket) {
  int bytes = 0;
  socklen_t size = sizeof(bytes);
  getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes / 2;
}

int open_udpm_socket(const UdpmAddress& address) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto fail = [&](const std::string& expected, const std::string& advice) {
    const std::string reason = std::strerror(errno);
    if (fd >= 0) close(fd);
    throw InputError::at("udpm " + name_of(address), expected, reason, advice);
  };
  if (fd < 0) fail("a UDP socket", "");
  // SO_REUSEADDR as liblcm does it: all of LCM's programs on a machine share the port.
  set(fd, SOL_SOCKET, SO_REUSEADDR, 1);
  set(fd, SOL_SOCKET, SO_RXQ_OVFL, 1);
  // Beyond net.core.rmem_max only if the program may administrate the network; else as much as is allowed.
  if (!set(fd, SOL_SOCKET, SO_RCVBUFFORCE, address.receive_buffer_bytes))
    set(fd, SOL_SOCKET, SO_RCVBUF, address.receive_buffer_bytes);

  sockaddr_in at{};
  at.sin_family = AF_INET;
  // Bound to the group, not to any address: unicast to the port is none of ours.
  at.sin_addr.s_addr = htonl(address.group);
  at.sin_port = htons(address.port);
  if (bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof(at)) != 0)
    fail("a free port", "another program holds it without sharing");
  const ip_mreqn group{{htonl(address.group)}, {htonl(INADDR_ANY)}, 0};
  if (!set(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, group))
    fail("a multicast route",
         "on the loopback: ip link set lo up multicast on; ip route add 224.0.0.0/4 dev lo");
  return fd;
}

}  // namespace edgepose
