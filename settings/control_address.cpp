#include "settings/control_address.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace edgepose {

std::filesystem::path default_control_socket() {
  const auto environment = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  if (const std::string path = environment("EDGEPOSE_SOCKET"); !path.empty()) return path;
  if (const std::string folder = environment("RUNTIME_DIRECTORY"); !folder.empty())
    return std::filesystem::path(folder) / "control.sock";
  const std::filesystem::path system = "/run/edgepose/control.sock";
  std::error_code ignored;
  if (geteuid() == 0 || std::filesystem::exists(system, ignored)) return system;
  if (const std::string folder = environment("XDG_RUNTIME_DIR"); !folder.empty())
    return std::filesystem::path(folder) / "edgepose/control.sock";
  return "/tmp/edgepose-" + std::to_string(geteuid()) + "/control.sock";
}

}  // namespace edgepose
