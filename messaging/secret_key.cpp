#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "common/error.h"
#include "common/missing_folder.h"
#include "messaging/authentication.h"

namespace edgepose {
namespace {

constexpr std::string_view kPrefix = "edgepose-key-1 ";
constexpr size_t kHexDigits = 2 * SecretKey::kBytes;
constexpr mode_t kForbidden = 0137;  // more than its owner's reading and writing and its group's reading

void start_sodium() {
  if (sodium_init() < 0) throw InputError::at("libsodium", "that it starts", "a failure");
}

class File {
 public:
  File(const std::filesystem::path& path, int flags, mode_t mode)
      : fd_(open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

SecretKey::~SecretKey() { sodium_memzero(bytes_.data(), bytes_.size()); }

SecretKey SecretKey::random() {
  start_sodium();
  SecretKey key;
  randombytes_buf(key.bytes_.data(), key.bytes_.size());
  return key;
}

SecretKey SecretKey::read(const std::filesystem::path& path) {
  start_sodium();
  const File file(path, O_RDONLY | O_NONBLOCK, 0);
  struct stat state {};
  if (file.get() < 0 || fstat(file.get(), &state) != 0)
    throw InputError::at(path.string(), "a key file", std::strerror(errno), "edgepose keygen makes one");
  if (!S_ISREG(state.st_mode)) throw InputError::at(path.string(), "a key file", "no regular file");
  if (state.st_mode & kForbidden)
    throw InputError::at(path.string(), "a key that only its owner, and perhaps its group, can read",
                         "a mode that gives others more", "chmod 600 it");
  std::array<char, kPrefix.size() + kHexDigits + 2> text{};
  const ssize_t size = ::read(file.get(), text.data(), text.size());
  std::string_view line(text.data(), size < 0 ? 0 : static_cast<size_t>(size));
  if (line.ends_with('\n')) line.remove_suffix(1);
  SecretKey key;
  size_t digits = 0;
  const bool sound = line.size() == kPrefix.size() + kHexDigits && line.starts_with(kPrefix) &&
                     sodium_hex2bin(key.bytes_.data(), kBytes, line.data() + kPrefix.size(), kHexDigits,
                                    nullptr, &digits, nullptr) == 0 &&
                     digits == kBytes;
  sodium_memzero(text.data(), text.size());
  if (!sound)
    throw InputError::at(path.string(), "one line 'edgepose-key-1' and 64 hex digits", "something else",
                         "edgepose keygen makes one");
  return key;
}

void SecretKey::write(const std::filesystem::path& path) const {
  std::array<char, kHexDigits + 1> hex{};
  sodium_bin2hex(hex.data(), hex.size(), bytes_.data(), kBytes);
  std::string line = std::string(kPrefix) + hex.data() + "\n";
  const File file(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  const bool written = file.get() >= 0 &&
                       ::write(file.get(), line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
                       fsync(file.get()) == 0;
  const int reason = errno;
  sodium_memzero(line.data(), line.size());
  sodium_memzero(hex.data(), hex.size());
  if (written) return;
  if (file.get() >= 0) unlink(path.c_str());
  refuse_missing_folder(path, reason);
  throw InputError::at(path.string(), "a new key file that can be written", std::strerror(reason),
                       reason == EEXIST ? "a key is never replaced; remove it first" : "");
}

}  // namespace edgepose
