#include "common/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "common/error.h"

namespace edgepose {
namespace {

/// The temporary file: removed again unless it was renamed into place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target) : path_(target.string() + ".XXXXXX") {
    descriptor_ = mkstemp(path_.data());
    if (descriptor_ < 0) fail(target, "cannot create a file beside it");
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!path_.empty()) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write_all(const std::filesystem::path& target, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(target, "cannot write");
      bytes = bytes.subspan(static_cast<size_t>(written));
    }
  }

  void rename_to(const std::filesystem::path& target) {
    if (fchmod_to_default() != 0 || fsync(descriptor_) != 0) fail(target, "cannot flush to disk");
    if (rename(path_.c_str(), target.c_str()) != 0) fail(target, "cannot rename into place");
    path_.clear();
  }

 private:
  /// mkstemp makes 0600; users expect what their umask says.
  int fchmod_to_default() const {
    const mode_t mask = umask(0);
    umask(mask);
    return fchmod(descriptor_, 0666 & ~mask);
  }
  [[noreturn]] static void fail(const std::filesystem::path& target, const char* doing) {
    throw InputError(target.string() + ": " + doing + ": " + std::strerror(errno));
  }

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  TemporaryFile file(path);
  file.write_all(path, bytes);
  file.rename_to(path);
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  write_file_atomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace edgepose
