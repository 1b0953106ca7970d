#pragma once
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "matcher/track.h"
#include "server/registered_model.h"
#include "server/service_options.h"

namespace edgepose {

/// Which frame it is.
struct FrameMark {
  std::string camera;
  int64_t sequence = 0, capture_utime = 0;
};

/// Remembers, for each camera and model, where the model was last. But for long pauses only the frames'
/// numbers count, not their times: a session that is replayed at another speed gives the same poses. Not
/// thread-safe.
class Tracker {
 public:
  struct Memory {
    std::vector<TrackStart> instances;
    std::vector<double> margins;  ///< of each, when it was detected
    int64_t sequence = 0;         ///< frame that they were seen in
    int64_t capture_utime = 0;    ///< [us] of that frame
    int since_detection = 0;
  };

  /// Where `model` is to be followed from in this frame; nullptr: it must be detected.
  const Memory* find(const RegisteredModel& model, const FrameMark& frame,
                     const TrackingOptions& options) const;
  /// Whether it is time to search the whole image all the same.
  static bool is_due(const Memory& memory, const TrackingOptions& options);
  /// What the frame says of the model: accepted detections are followed, without any it is lost.
  void remember(const RegisteredModel& model, const FrameMark& frame, const MatchResult& result,
                bool was_detected);

 private:
  using Key = std::tuple<std::string, std::string, int64_t>;  // camera, model's name and content hash
  static Key key_of(const RegisteredModel& model, const FrameMark& frame);
  std::map<Key, Memory> memories_;
};

}  // namespace edgepose
