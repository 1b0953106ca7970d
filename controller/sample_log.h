#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "controller/arm_controller.h"

namespace edgepose {

/// Writes one line of CSV for each cycle. The file always ends with a whole line: what a full disk has no
/// room for is counted, and writing goes on when there is room. Nothing throws once it is open. One thread.
class SampleLog {
 public:
  /// Throws InputError if the file cannot be made; one of the name is replaced.
  explicit SampleLog(const std::filesystem::path& path);
  SampleLog(const SampleLog&) = delete;
  SampleLog& operator=(const SampleLog&) = delete;
  ~SampleLog();  ///< flushes

  void write(const ControlSample& sample);
  void flush();
  uint64_t lost() const { return lost_; }  ///< lines for which the disk had no room

 private:
  int descriptor_ = -1;
  std::string buffer_;
  uint64_t lines_ = 0, lost_ = 0;  ///< in the buffer; ever
  int64_t file_bytes_ = 0;
};

}  // namespace edgepose
