#include "settings/control_address.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "common/error.h"

namespace edgepose {
namespace {

/// Anybody can make folders in /tmp: one that somebody else has made there is not talked to.
std::filesystem::path own_folder(const std::filesystem::path& folder) {
  struct stat state {};
  if (lstat(folder.c_str(), &state) == 0 &&
      (!S_ISDIR(state.st_mode) || state.st_uid != geteuid() || (state.st_mode & (S_IWGRP | S_IWOTH)) != 0))
    throw InputError::at(folder.string(), "a folder that only its owner, the user, can write", "another",
                         "set EDGEPOSE_SOCKET to a place of your own");
  return folder;
}

}  // namespace

std::filesystem::path default_control_socket() {
  const auto environment = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  if (const std::string path = environment("EDGEPOSE_SOCKET"); !path.empty()) return path;
  if (const std::string folder = environment("RUNTIME_DIRECTORY"); !folder.empty())
    return std::filesystem::path(folder) / "control.sock";
  std::filesystem::path system = "/run/edgepose/control.sock";
  std::error_code ignored;
  if (geteuid() == 0 || std::filesystem::exists(system, ignored)) return system;
  if (const std::string folder = environment("XDG_RUNTIME_DIR"); !folder.empty())
    return std::filesystem::path(folder) / "edgepose/control.sock";
  return own_folder("/tmp/edgepose-" + std::to_string(geteuid())) / "control.sock";
}

}  // namespace edgepose
