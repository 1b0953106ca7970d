#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace edgepose {

/// A regular file opened for reading, closed again by the destructor.
class RegularFile {
 public:
  /// Throws InputError if the file is missing, a folder, a device or pipe, unreadable or empty.
  RegularFile(const std::filesystem::path& path, const std::string& what);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  int descriptor() const { return descriptor_; }
  size_t size() const { return size_; }  ///< bytes; at least 1
  static std::string last_error();       ///< errno in words, for messages

 private:
  int descriptor_ = -1;
  size_t size_ = 0;
};

}  // namespace edgepose
