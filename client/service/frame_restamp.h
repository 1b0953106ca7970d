#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace edgepose {

/// Makes frames from a log look as if they were taken now. Not thread-safe.
class FrameRestamp {
 public:
  /// What a message on the frames' channels was.
  enum class Outcome {
    kDone,       ///< changed
    kMalformed,  ///< no frame, as it was
    kBeyond,     ///< its sequence number cannot be moved so far, as it was
  };

  /// `first`: the first frame of each camera gets this sequence number; the others keep their differences to
  /// it.
  explicit FrameRestamp(int64_t first) : first_(first) {}

  /// Changes the encoded depth_frame_t or cloud_frame_t (`channel` tells which): capture_utime becomes
  /// `now_utime`, the sequence number is moved. All else, the checksum as well, stays bit for bit.
  Outcome restamp(const std::string& channel, int64_t now_utime, std::vector<std::byte>& message);

 private:
  template <class Message>
  Outcome restamp_as(int64_t now_utime, std::vector<std::byte>& message);

  int64_t first_;
  std::map<std::string, int64_t> logged_first_;  // of each camera
};

/// Camera and number of a frame, as decoding tells; false if `message` is no frame of that channel.
bool frame_identity(const std::string& channel, const std::vector<std::byte>& message, std::string& camera,
                    int64_t& sequence);

}  // namespace edgepose
