#include "client/service/control_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace edgepose {
namespace {

constexpr int kConnectTimeout = 5000;  // [ms]

[[noreturn]] void fail(const ControlAddress& address, int socket, int cause) {
  if (socket >= 0) close(socket);
  const bool denied = cause == EACCES || cause == EPERM;
  throw InputError::at(address.text(), "a running " + address.program, std::strerror(cause),
                       denied ? "only its owner and group may command it (mode 0660)" : address.advice);
}

/// A Unix socket's connect() may say EAGAIN at once; TCP's says EINPROGRESS.
void connect_to(const ControlAddress& address, int socket, const sockaddr* to, socklen_t size) {
  if (connect(socket, to, size) == 0) return;
  if (errno != EINPROGRESS) fail(address, socket, errno);
  pollfd waits{socket, POLLOUT, 0};
  if (poll(&waits, 1, kConnectTimeout) <= 0) fail(address, socket, ETIMEDOUT);
  int cause = 0;
  socklen_t length = sizeof(cause);
  getsockopt(socket, SOL_SOCKET, SO_ERROR, &cause, &length);
  if (cause != 0) fail(address, socket, cause);
}

}  // namespace

int open_control_socket(const ControlAddress& address) {
  const int type = SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK;
  if (address.port > 0) {
    const int fd = socket(AF_INET, type, 0);
    if (fd < 0) fail(address, fd, errno);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(static_cast<uint16_t>(address.port));
    connect_to(address, fd, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
    return fd;
  }
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  const std::string path = address.socket.string();
  if (path.empty() || path.size() >= sizeof(to.sun_path))
    throw InputError::at("--socket", "a path of 1 to 107 bytes", std::to_string(path.size()) + " bytes");
  std::memcpy(to.sun_path, path.c_str(), path.size() + 1);
  const int fd = socket(AF_UNIX, type, 0);
  if (fd < 0) fail(address, fd, errno);
  connect_to(address, fd, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  return fd;
}

}  // namespace edgepose
