#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace edgepose {

/// A folder of its own, removed at the end. In /tmp, since a socket's path must be short.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = "/tmp/edgepose_bus_XXXXXX";
    if (!mkdtemp(name.data())) ADD_FAILURE() << "no folder in /tmp";
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace edgepose
