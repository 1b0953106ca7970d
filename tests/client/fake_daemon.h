#pragma once
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace edgepose::test {

/// Listens on a Unix socket and answers each line with what `reply` makes of it, byte for byte. An empty
/// reply: silence. One client at a time.
class FakeDaemon {
 public:
  using Reply = std::function<std::string(const std::string& line)>;

  explicit FakeDaemon(Reply reply, bool hangs_up = false)
      : path_(std::filesystem::temp_directory_path() /
              ("edgepose_fake_" + std::to_string(getpid()) + ".sock")),
        reply_(std::move(reply)),
        hangs_up_(hangs_up),
        listener_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)),
        wake_(eventfd(0, EFD_CLOEXEC)) {
    std::filesystem::remove(path_);
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    std::strncpy(at.sun_path, path_.c_str(), sizeof(at.sun_path) - 1);
    if (bind(listener_, reinterpret_cast<const sockaddr*>(&at), sizeof(at)) != 0 || listen(listener_, 4) != 0)
      throw std::runtime_error("cannot listen");
    thread_ = std::thread([this] { run(); });
  }
  FakeDaemon(const FakeDaemon&) = delete;
  FakeDaemon& operator=(const FakeDaemon&) = delete;
  ~FakeDaemon() {
    eventfd_write(wake_, 1);
    thread_.join();
    close(listener_);
    close(wake_);
    std::filesystem::remove(path_);
  }

  const std::filesystem::path& path() const { return path_; }
  std::vector<std::string> requests() {
    const std::scoped_lock lock(mutex_);
    return requests_;
  }

 private:
  bool readable(int descriptor) const {
    pollfd waits[] = {{descriptor, POLLIN, 0}, {wake_, POLLIN, 0}};
    return poll(waits, 2, -1) > 0 && waits[1].revents == 0;
  }
  void run() {
    while (readable(listener_)) {
      const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      serve(client);
      close(client);
    }
  }
  void serve(int client) {
    std::string received;
    char buffer[4096];
    while (!hangs_up_ && readable(client)) {
      const ssize_t some = recv(client, buffer, sizeof(buffer), 0);
      if (some <= 0) return;
      received.append(buffer, static_cast<size_t>(some));
      for (size_t end; (end = received.find('\n')) != std::string::npos; received.erase(0, end + 1)) {
        const std::string line = received.substr(0, end);
        {
          const std::scoped_lock lock(mutex_);
          requests_.push_back(line);
        }
        const std::string answer = reply_(line);
        for (size_t sent = 0; sent < answer.size();) {
          const ssize_t n = send(client, answer.data() + sent, answer.size() - sent, MSG_NOSIGNAL);
          if (n <= 0) return;
          sent += static_cast<size_t>(n);
        }
      }
    }
  }

  const std::filesystem::path path_;
  const Reply reply_;
  const bool hangs_up_;
  int listener_, wake_;
  std::mutex mutex_;
  std::vector<std::string> requests_;
  std::thread thread_;
};

}  // namespace edgepose::test
