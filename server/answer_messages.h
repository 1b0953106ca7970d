#pragma once
#include "edgepose_lcm/drill_targets_t.hpp"
#include "edgepose_lcm/pose_estimates_t.hpp"
#include "server/frame_answer.h"

namespace edgepose {

/// The answer as it is published; send_utime and authentication are left for the sender.
edgepose_lcm::pose_estimates_t to_poses(const WaitingFrame& frame, const FrameAnswer& answer);

/// When a hole may be drilled.
struct TargetOptions {
  double min_margin = 0.1;  ///< [0, 1] of the pose over a clearly different one
  double max_age = 1.0;     ///< [s] of the frame, FrameOptions::max_age
};

/// The planned holes of every accepted detection of a model with a plan: in the camera frame, with what the
/// pose's covariance makes of them, and go or the reason why not. `age`: [s] of the frame now.
edgepose_lcm::drill_targets_t to_drill_targets(const WaitingFrame& frame, const FrameAnswer& answer,
                                               const TargetOptions& options = {}, double age = 0);

}  // namespace edgepose
