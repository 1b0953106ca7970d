#pragma once
#include <map>
#include <string>
#include <vector>

#include "matcher/track.h"
#include "server/registered_model.h"
#include "server/service_options.h"

namespace edgepose {

/// Remembers, for each camera and model, where the model was last. Times play no part, only the frames'
/// numbers: a session that is replayed at another speed gives the same poses. Not thread-safe.
class Tracker {
 public:
  struct Memory {
    std::vector<TrackStart> instances;
    int64_t sequence = 0;  ///< frame that they were seen in
    int since_detection = 0;
  };

  /// Where `model` is to be followed from in this frame; nullptr: it must be detected.
  const Memory* find(const std::string& camera, const RegisteredModel& model, int64_t sequence,
                     const TrackingOptions& options) const;
  /// Whether it is time to search the whole image all the same.
  static bool is_due(const Memory& memory, const TrackingOptions& options);
  /// What the frame says of the model: accepted detections are followed, without any it is lost.
  void remember(const std::string& camera, const RegisteredModel& model, int64_t sequence,
                const MatchResult& result, bool was_detected);

 private:
  using Key = std::pair<std::string, int64_t>;  // camera, content hash
  std::map<Key, Memory> memories_;
};

}  // namespace edgepose
