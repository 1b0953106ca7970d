#include "daemon/listening_socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr int kBacklog = 16;
constexpr mode_t kSocketMode = 0660;

int new_socket(int family) { return socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

InputError failure(const std::string& where, const std::string& what) {
  return InputError::at(where, what, std::strerror(errno));
}

/// A file beside the socket, locked as long as the daemon lives: whoever holds it may replace the socket.
int lock_beside(const std::filesystem::path& path) {
  const std::string file = path.string() + ".lock";
  const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0640);
  if (lock < 0) throw failure(file, "a folder that the daemon may write");
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
    close(lock);
    throw InputError::at(path.string(), "a socket that nobody listens on", "another program there",
                         "stop that one, or name another socket");
  }
  return lock;
}

}  // namespace

ListeningSocket ListeningSocket::on_file(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.string().size() >= sizeof(address.sun_path))
    throw InputError::at(path.string(), "a socket path of less than 108 bytes",
                         std::to_string(path.string().size()));
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  std::error_code failed;
  // Whatever the umask: clients refuse a folder in /tmp that others can write.
  if (path.has_parent_path() && std::filesystem::create_directories(path.parent_path(), failed))
    std::filesystem::permissions(path.parent_path(), std::filesystem::perms(0755), failed);
  if (failed)
    throw InputError::at(path.string(), "a folder that can be made for the socket", failed.message());
  const int lock = lock_beside(path);
  if (std::filesystem::is_socket(path, failed)) unlink(path.c_str());
  ListeningSocket made(new_socket(AF_UNIX), lock, path);
  const mode_t old_mask = umask(0777 & ~kSocketMode);
  const int bound = made.descriptor_ < 0 ? -1
                                         : bind(made.descriptor_, reinterpret_cast<const sockaddr*>(&address),
                                                sizeof(address));
  const int error = errno;
  umask(old_mask);
  if (bound != 0) {
    made.path_.clear();  // what stands there is not ours
    errno = error;
    throw failure(path.string(), "a place for the control socket");
  }
  if (listen(made.descriptor_, kBacklog) != 0) throw failure(path.string(), "to listen");
  return made;
}

ListeningSocket ListeningSocket::on_loopback(int port) {
  ListeningSocket made(new_socket(AF_INET), -1, {});
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int yes = 1;
  if (made.descriptor_ >= 0) setsockopt(made.descriptor_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  if (made.descriptor_ < 0 ||
      bind(made.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      listen(made.descriptor_, kBacklog) != 0)
    throw failure("127.0.0.1:" + std::to_string(port), "a port that is free");
  return made;
}

ListeningSocket::ListeningSocket(ListeningSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      lock_(std::exchange(other.lock_, -1)),
      path_(std::exchange(other.path_, {})) {}

ListeningSocket::~ListeningSocket() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!path_.empty()) unlink(path_.c_str());
  if (lock_ >= 0) close(lock_);
}

}  // namespace edgepose
