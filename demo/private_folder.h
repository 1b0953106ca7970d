#pragma once
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "common/error.h"

namespace edgepose {

/// A folder for this user only, removed with all that is in it at the end. In /tmp whatever TMPDIR says,
/// since the path of a Unix socket must be short.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string name = "/tmp/edgepose-demo-XXXXXX";
    if (mkdtemp(name.data()) == nullptr)
      throw InputError::at("/tmp", "room for a temporary folder", std::strerror(errno));
    path_ = name;
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  ~PrivateFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace edgepose
