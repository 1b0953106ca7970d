#pragma once
#include <filesystem>
#include <fstream>
#include <string>

#include "bus/can_bus.h"

namespace edgepose {

/// Reads captures of link type 227, foreign and damaged ones as well, of either byte order, in micro- or
/// nanoseconds. Nothing in the file is trusted.
class PcapReader {
 public:
  /// Throws InputError unless it is such a capture.
  explicit PcapReader(const std::filesystem::path& path);

  /// The next frame or event, its time in `frame.time_ns`: [ns] since 1970, UTC, as the file has it. kNothing
  /// at the end.
  Received next();

  uint64_t skipped() const {
    return skipped_;
  }  ///< records that are no frame (extended, remote, FD, damaged)
  bool is_cut_off() const {
    return cut_off_;
  }  ///< known at the end: it ends within a record, or at a length that cannot be

 private:
  uint32_t number(const uint8_t* at) const;

  std::ifstream file_;
  bool swapped_ = false, cut_off_ = false;
  uint32_t fraction_ns_ = 1000;  ///< [ns] of one unit of a record's fraction
  uint64_t skipped_ = 0;
};

}  // namespace edgepose
