#pragma once
#include <filesystem>

namespace edgepose {

/// A socket that clients connect to, closed (and its file removed) by the destructor.
class ListeningSocket {
 public:
  /// A Unix socket of mode 0660; its folder is made if need be. Throws InputError if another daemon listens
  /// there, or it cannot be made; what a daemon that was killed has left is replaced.
  static ListeningSocket on_file(const std::filesystem::path& path);
  /// TCP on 127.0.0.1. Throws InputError if the port is taken.
  static ListeningSocket on_loopback(int port);

  ListeningSocket(ListeningSocket&& other) noexcept;
  ListeningSocket& operator=(ListeningSocket&&) = delete;
  ~ListeningSocket();
  int descriptor() const { return descriptor_; }
  bool is_tcp() const { return path_.empty(); }

 private:
  ListeningSocket(int descriptor, int lock, std::filesystem::path path)
      : descriptor_(descriptor), lock_(lock), path_(std::move(path)) {}

  int descriptor_, lock_;
  std::filesystem::path path_;
};

}  // namespace edgepose
