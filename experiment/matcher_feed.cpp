#include "experiment/matcher_feed.h"

#include <utility>

#include "messaging/channels.h"
#include "messaging/lcm_publisher.h"

namespace edgepose {

MatcherFeed::MatcherFeed(const WorkCell& cell, ModelHandle model, const Camera& told,
                         const CellCameraOptions& camera)
    : camera_(cell, told, camera), models_{std::move(model)} {
  options_.match.threads = 1;  // trials run side by side
}

MatcherFeed::Look MatcherFeed::look(const JointVector& joints, int64_t capture_utime) {
  Look look;
  look.frame.depth = camera_.capture(joints, capture_utime);
  look.frame.receive_utime = capture_utime;
  look.answer = answerer_.answer(look.frame.depth, models_, options_);
  return look;
}

std::vector<OutgoingMessage> MatcherFeed::messages(const JointVector& joints, int64_t capture_utime) {
  const Look seen = look(joints, capture_utime);
  edgepose_lcm::pose_estimates_t poses = to_poses(seen.frame, seen.answer);
  edgepose_lcm::drill_targets_t targets = to_drill_targets(seen.frame, seen.answer);
  poses.send_utime = targets.send_utime = capture_utime;
  return {{channels::kPoses, encode(poses)}, {channels::kDrillTargets, encode(targets)}};
}

std::optional<RigidTransform> MatcherFeed::pose(const JointVector& joints, int64_t capture_utime) {
  const Look seen = look(joints, capture_utime);
  const std::vector<Detection>& found = seen.answer.models.front().result.detections;
  if (found.empty() || !found.front().accepted) return std::nullopt;
  return found.front().camera_T_model;
}

ModelHandle trained_model(const WorkCell& cell) {
  auto made = std::make_shared<RegisteredModel>();
  made->name = cell.plan.model;
  made->model = train_model(cell.model, cell.plan.model);
  made->content_hash = 1;
  made->plan = cell.plan;
  return made;
}

}  // namespace edgepose
