#pragma once
#include <optional>
#include <vector>

#include "server/answer_messages.h"
#include "server/frame_answer.h"
#include "simulator/cell_camera.h"
#include "simulator/pose_source.h"

namespace edgepose {

/// The pose service in simulated time: the daemon's own work on the frames of a simulated camera, and the
/// messages that it would publish. Not safe for use by several threads at once.
class MatcherFeed {
 public:
  /// `cell` must live longer. `told`: the intrinsics that the frames claim.
  MatcherFeed(const WorkCell& cell, ModelHandle model, const Camera& told, const CellCameraOptions& camera);

  /// As PoseFeed: sees the arm at these joints [rad].
  std::vector<OutgoingMessage> messages(const JointVector& joints, int64_t capture_utime);

  /// camera_T_model as the service finds it; nothing if it accepts none.
  std::optional<RigidTransform> pose(const JointVector& joints, int64_t capture_utime);

 private:
  struct Look {
    WaitingFrame frame;
    FrameAnswer answer;
  };
  Look look(const JointVector& joints, int64_t capture_utime);

  CellCamera camera_;
  const ModelList models_;
  FrameAnswerer answerer_;
  AnswerOptions options_;
};

/// Trains the cell's model and gives it the cell's plan, as registering it would.
ModelHandle trained_model(const WorkCell& cell);

}  // namespace edgepose
