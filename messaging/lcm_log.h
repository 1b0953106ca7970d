#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace edgepose {

/// One record of an LCM log.
struct LoggedMessage {
  int64_t event = 0;          ///< number in its log
  int64_t receive_utime = 0;  ///< [us] since 1970, UTC: when the logger received it
  std::string channel;
  std::vector<std::byte> data;
};

/// Reads LCM logs, foreign and damaged ones as well: what is no record is skipped up to the next one, and a
/// log that is cut off is read as far as it goes. Records are bounded whatever their lengths say.
class LcmLogReader {
 public:
  /// Throws InputError if there is no file that can be read, or no record in its beginning.
  explicit LcmLogReader(const std::filesystem::path& path);

  /// The next record; false at the end.
  bool next(LoggedMessage& message);

  uint64_t skipped_bytes() const { return skipped_; }  ///< that belong to no record
  bool is_cut_off() const { return cut_off_; }         ///< known at the end

 private:
  bool find_sync();

  std::ifstream file_;
  uint64_t size_ = 0, at_ = 0, skipped_ = 0;
  bool cut_off_ = false;
};

}  // namespace edgepose
