#pragma once
#include <sys/socket.h>
#include <sys/un.h>

#include <filesystem>
#include <string>

#include "common/error.h"

namespace edgepose {

struct UnixAddress {
  sockaddr_un value{};
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&value); }
};

/// Throws InputError if the path is empty or longer than a socket's may be.
inline UnixAddress unix_address(const std::filesystem::path& path) {
  UnixAddress address;
  const std::string text = path.string();
  if (text.empty() || text.size() >= sizeof(address.value.sun_path))
    throw InputError::at("bus unix:" + text, "a socket path of 1 to 107 bytes", std::to_string(text.size()));
  address.value.sun_family = AF_UNIX;
  text.copy(address.value.sun_path, text.size());
  return address;
}

}  // namespace edgepose
