#include "files/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/error.h"

namespace edgepose {
namespace {

/// What stands in the way of reading it as a file; empty if nothing does.
std::string obstacle(const struct stat& status) {
  if (S_ISDIR(status.st_mode)) return "a folder";
  if (!S_ISREG(status.st_mode)) return "something that is not a regular file";
  if (status.st_size == 0) return "an empty file";
  return "";
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& path, const std::string& what) {
  // Non-blocking: opening a pipe nobody writes to must not hang.
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    const bool missing = errno == ENOENT || errno == ENOTDIR;
    throw InputError::at(path.string(), what, missing ? "no such file" : last_error(),
                         missing ? "check the path" : "");
  }
  struct stat status {};
  std::string found = fstat(descriptor_, &status) == 0 ? obstacle(status) : last_error();
  if (!found.empty()) {
    close(descriptor_);
    throw InputError::at(path.string(), what, found);
  }
  size_ = static_cast<size_t>(status.st_size);
}

RegularFile::~RegularFile() { close(descriptor_); }

std::string RegularFile::last_error() { return std::strerror(errno); }

}  // namespace edgepose
