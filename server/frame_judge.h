#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "server/service_options.h"

namespace edgepose {

/// What the times and the number of a frame say.
struct FrameVerdict {
  std::string refusal;     ///< empty: it may be looked at; else the counter's name
  std::string detail;      ///< "FIELD: expected E, found F"
  int64_t lost = 0;        ///< frames missing before this one
  bool restarted = false;  ///< the camera has begun to count anew
};

/// Judges the frames of each camera by capture time and sequence number. Not thread-safe.
class FrameJudge {
 public:
  /// `receive_utime`: [us] since 1970, the receiver's clock.
  FrameVerdict judge(const std::string& camera, int64_t sequence, int64_t capture_utime,
                     int64_t receive_utime, const FrameOptions& options);
  /// A frame that is refused for what it holds: it is not missing before the next one. False if the camera is
  /// not known.
  bool skip(const std::string& camera, int64_t sequence);

 private:
  struct Mark {
    int64_t sequence = 0, capture_utime = 0;
  };
  struct Track {
    Mark last;            ///< the newest frame taken
    int64_t skipped = 0;  ///< frames after it that were refused for what they hold
    Mark strayed;         ///< the newest that went back
    int strays = 0;       ///< how many in a row that go on from each other
    int64_t heard = 0;    ///< [us] receive time
  };
  bool make_room(int64_t receive_utime, const FrameOptions& options);

  std::map<std::string, Track> cameras_;
};

}  // namespace edgepose
