#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "bus/can_frame.h"

namespace edgepose {

/// Records frames as a capture that Wireshark and tshark read. Whatever happens, the file ends with a whole
/// record: what a full disk has no room for is counted, and recording goes on when there is room again.
/// Nothing throws once it is open. Not thread-safe.
class PcapWriter {
 public:
  /// `wall_minus_steady_ns`: added to the frames' steady times, once for the whole file, so that setting the
  /// clock does not mix up the order. Throws InputError if the file cannot be made; one of the name is
  /// replaced.
  PcapWriter(const std::filesystem::path& path, int64_t wall_minus_steady_ns);
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;
  ~PcapWriter();  ///< flushes

  /// Buffered: in the file after flush(), or when 64 KiB have come together.
  void write(const CanFrame& frame);
  /// Hands everything to the system.
  void flush();

  uint64_t written() const { return written_; }   ///< frames in the file
  uint64_t lost() const { return lost_; }         ///< frames for which the disk had no room
  int last_error() const { return last_error_; }  ///< errno of the last loss; 0 if there was none

 private:
  int descriptor_ = -1;
  const int64_t wall_minus_steady_ns_;
  std::vector<uint8_t> buffer_;
  uint64_t file_bytes_ = 0, written_ = 0, lost_ = 0;
  int last_error_ = 0;
};

}  // namespace edgepose
