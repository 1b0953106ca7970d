#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgepose {

/// Writes an LCM log, as lcm-logger does, into its place as it comes. Whatever happens, the file ends with a
/// whole record. Not thread-safe.
class LcmLogWriter {
 public:
  enum class Existing { kRefuse, kReplace };

  /// Throws InputError if the file cannot be made, or exists and is not to be replaced.
  explicit LcmLogWriter(const std::filesystem::path& path, Existing existing = Existing::kRefuse);
  LcmLogWriter(const LcmLogWriter&) = delete;
  LcmLogWriter& operator=(const LcmLogWriter&) = delete;
  ~LcmLogWriter();  ///< writes what is buffered, if it can; nothing tells whether it could

  /// `receive_utime`: [us] since 1970, UTC. Buffered: on disk after flush(). Throws InputError if the disk is
  /// full: it says how much was kept, and nothing more is written from then on. Throws std::invalid_argument
  /// for a channel that no reader takes (empty, or longer than 255).
  void write(int64_t receive_utime, std::string_view channel, std::span<const std::byte> data);
  /// Hands everything to the system. Throws as write() does.
  void flush();
  /// flush(), and waits until it is on the disk.
  void close();

  /// Whole records in the file, buffered ones included, and the bytes that they take.
  uint64_t records() const { return kept_records_ + ends_.size(); }
  uint64_t bytes() const { return kept_bytes_ + buffer_.size(); }

 private:
  [[noreturn]] void fail(size_t written, int cause);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::vector<std::byte> buffer_;
  std::vector<size_t> ends_;  // of the records in the buffer
  uint64_t kept_records_ = 0, kept_bytes_ = 0, next_event_ = 0;
};

}  // namespace edgepose
