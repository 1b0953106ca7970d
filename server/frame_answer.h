#pragma once
#include <optional>

#include "matcher/match.h"
#include "server/frame_mailbox.h"
#include "server/registered_model.h"
#include "server/tracker.h"

namespace edgepose {

enum class AnswerMode { kDetection, kTracking, kSkipped };

/// What a frame says of one model.
struct ModelAnswer {
  ModelHandle model;
  AnswerMode mode = AnswerMode::kSkipped;
  MatchResult result;
};

/// What a frame says.
struct FrameAnswer {
  std::vector<ModelAnswer> models;  ///< in the models' order
  double preprocessing_seconds = 0;
  /// Some search was cut short or left out: what another model would have explained better may have been
  /// accepted.
  bool deadline_reached = false;
  int tracks_lost = 0, tracks_corrected = 0;
};

struct AnswerOptions {
  SceneOptions scene;
  MatchOptions match;
  TrackingOptions tracking;
  double deadline = 0;  ///< [s] from the call; 0 = none
};

/// Finds all models in one frame after the other: follows what it has found before, detects what is new or
/// lost. Not thread-safe.
class FrameAnswerer {
 public:
  /// Does not throw for any frame that the intake let through; `models` may change from frame to frame.
  FrameAnswer answer(const DepthFrame& frame, const ModelList& models, const AnswerOptions& options);

 private:
  class Frame;

  Tracker tracker_;
  size_t first_ = 0;  ///< the model that is looked for first: those left out come first next time
};

}  // namespace edgepose
