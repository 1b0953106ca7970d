#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace edgepose {

/// A file beside `target`, under a name of its own, that takes the target's place at the end. Removed again
/// if it never does: when it is destroyed, or by remove_temporary_files_on_signals(). Throws InputError that
/// names the target and the cause.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path target);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  const std::filesystem::path& target() const { return target_; }
  std::filesystem::path path() const { return name_.get(); }
  /// Writes all of the content and flushes it to disk.
  void write(std::span<const std::byte> bytes);
  /// Puts it in the target's place.
  void rename_to_target();

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::filesystem::path target_;
  std::unique_ptr<char[]> name_;  ///< at one place for life: a signal handler may read it at any time
  int slot_ = -1;                 ///< in the handler's list
  int descriptor_ = -1;
};

/// From now on, a program that SIGHUP, SIGINT or SIGTERM ends removes its temporary files first. Signals that
/// are ignored (nohup) stay so.
void remove_temporary_files_on_signals();

}  // namespace edgepose
