#include "common/temporary_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "common/error.h"
#include "common/missing_folder.h"

namespace edgepose {
namespace {

/// What a signal handler removes: it may neither lock nor allocate, so a fixed list of lock-free pointers.
/// Files beyond it are written all the same.
constexpr size_t kSlots = 64;
std::array<std::atomic<const char*>, kSlots> unfinished{};
static_assert(std::atomic<const char*>::is_always_lock_free);

int enlist(const char* name) {
  for (size_t i = 0; i < kSlots; ++i) {
    const char* free_slot = nullptr;
    if (unfinished[i].compare_exchange_strong(free_slot, name)) return static_cast<int>(i);
  }
  return -1;
}

extern "C" void remove_and_end(int signal_number) {
  for (const auto& slot : unfinished)
    if (const char* name = slot.load()) unlink(name);
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);  // so that the caller sees how the program ended
}

/// mkstemp makes 0600; users expect the mode of the file that is replaced, or what their umask says.
mode_t mode_for(const std::filesystem::path& target) {
  struct stat status {};
  if (stat(target.c_str(), &status) == 0) return status.st_mode & 0777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

TemporaryFile::TemporaryFile(std::filesystem::path target) : target_(std::move(target)) {
  const std::string pattern = target_.string() + ".XXXXXX";
  name_ = std::make_unique<char[]>(pattern.size() + 1);
  std::memcpy(name_.get(), pattern.c_str(), pattern.size() + 1);
  slot_ = enlist(name_.get());  // before the file is there: nothing in between can be lost
  descriptor_ = mkstemp(name_.get());
  if (descriptor_ >= 0) return;
  const int cause = errno;
  if (slot_ >= 0) unfinished[static_cast<size_t>(slot_)] = nullptr;
  errno = cause;
  fail("made, first under a name beside it");
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : target_(std::move(other.target_)),
      name_(std::move(other.name_)),
      slot_(std::exchange(other.slot_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

TemporaryFile::~TemporaryFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (name_) unlink(name_.get());
  if (slot_ >= 0) unfinished[static_cast<size_t>(slot_)] = nullptr;
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("written");
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
  if (fchmod(descriptor_, mode_for(target_)) != 0 || fsync(descriptor_) != 0) fail("written to disk");
  if (close(std::exchange(descriptor_, -1)) != 0) fail("written");
}

void TemporaryFile::rename_to_target() {
  if (rename(name_.get(), target_.c_str()) != 0) fail("renamed into place");
  // Another file may take the old name at once: neither the handler nor the destructor may remove that.
  if (slot_ >= 0) unfinished[static_cast<size_t>(std::exchange(slot_, -1))] = nullptr;
  name_.reset();
}

void TemporaryFile::fail(const char* doing) const {
  const int cause = errno;
  refuse_missing_folder(target_, cause);
  const bool full = cause == ENOSPC || cause == EDQUOT || cause == EFBIG;
  throw InputError::at(target_.string(), std::string("a file that can be ") + doing, std::strerror(cause),
                       full ? "make room, or name another place" : "name another place");
}

void remove_temporary_files_on_signals() {
  for (const int number : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = remove_and_end;
    sigaction(number, &action, nullptr);
  }
}

}  // namespace edgepose
