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
/// unless told otherwise: the path of a Unix socket must be short. Throws InputError if there is no room.
class PrivateFolder {
 public:
  explicit PrivateFolder(const std::string& prefix, const std::filesystem::path& parent = "/tmp") {
    std::string name = parent / (prefix + "XXXXXX");
    if (mkdtemp(name.data()) == nullptr)
      throw InputError::at(parent.string(), "room for a temporary folder", std::strerror(errno));
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
