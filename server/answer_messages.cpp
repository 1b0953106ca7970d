#include "server/answer_messages.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/number_text.h"
#include "messaging/transform_message.h"
#include "planning/placed_target.h"

namespace edgepose {
namespace {

int8_t code_of(AnswerMode mode) {
  using edgepose_lcm::model_answer_t;
  switch (mode) {
    case AnswerMode::kDetection:
      return model_answer_t::DETECTION;
    case AnswerMode::kTracking:
      return model_answer_t::TRACKING;
    case AnswerMode::kSkipped:
      return model_answer_t::SKIPPED;
  }
  return model_answer_t::SKIPPED;
}

edgepose_lcm::detection_t detection_message(const Detection& detection, AnswerMode mode) {
  edgepose_lcm::detection_t m{};
  m.camera_T_model = to_message(detection.camera_T_model);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) m.covariance[row][column] = detection.covariance(row, column);
  m.score = detection.score;
  m.accepted = detection.accepted;
  m.coverage = detection.coverage;
  m.violations = detection.violations;
  m.edge_score = detection.edge_score;
  m.margin = mode == AnswerMode::kTracking ? 1 : detection.margin;
  for (const RigidTransform& pose : detection.equivalent) m.camera_T_equivalent.push_back(to_message(pose));
  m.equivalents = static_cast<int32_t>(m.camera_T_equivalent.size());
  return m;
}

edgepose_lcm::model_answer_t answer_message(const ModelAnswer& answer) {
  edgepose_lcm::model_answer_t m{};
  const MatchResult& result = answer.result;
  m.model = answer.model->name;
  m.content_hash = answer.model->content_hash;
  m.mode = code_of(answer.mode);
  m.reason = result.reason;
  m.sampling_seconds = result.times.sampling;
  m.voting_seconds = result.times.voting;
  m.clustering_seconds = result.times.clustering;
  m.verification_seconds = result.times.verification;
  m.refinement_seconds = result.times.refinement;
  for (const Detection& detection : result.detections)
    m.detections.push_back(detection_message(detection, answer.mode));
  m.detections_count = static_cast<int32_t>(m.detections.size());
  return m;
}

std::string millimetres(double metres) { return number_text(1e3 * metres, 3) + " mm"; }
std::string degrees(double radians) { return number_text(radians * 180 / std::numbers::pi, 3) + " degrees"; }

/// Empty if two standard deviations stay within what the plan allows.
std::string doubt(const PlacedTarget& placed) {
  if (placed.certain) return "";
  const double sigma = std::max(placed.entry_sigma, placed.bottom_sigma);
  if (2 * sigma > placed.target.position_tolerance)
    return "position: two standard deviations are " + millimetres(2 * sigma) + ", the plan allows " +
           millimetres(placed.target.position_tolerance);
  if (2 * placed.angle_sigma > placed.target.angle_tolerance)
    return "angle: two standard deviations are " + degrees(2 * placed.angle_sigma) + ", the plan allows " +
           degrees(placed.target.angle_tolerance);
  return "the pose's uncertainty is not known";
}

edgepose_lcm::drill_target_t target_message(const PlacedTarget& placed, const RegisteredModel& model) {
  edgepose_lcm::drill_target_t m{};
  const DrillTarget& target = placed.target;
  m.model = model.name;
  m.content_hash = model.content_hash;
  m.instance = static_cast<int32_t>(placed.instance);
  m.name = target.name;
  for (int i = 0; i < 3; ++i) m.entry[i] = target.entry[i], m.axis[i] = target.axis[i];
  m.depth = target.depth;
  m.diameter = target.diameter;
  m.entry_sigma = placed.entry_sigma;
  m.tip_sigma = placed.bottom_sigma;
  m.angle_sigma = placed.angle_sigma;
  m.position_tolerance = target.position_tolerance;
  m.angle_tolerance = target.angle_tolerance;
  m.reason = doubt(placed);
  m.go = m.reason.empty();
  return m;
}

}  // namespace

edgepose_lcm::pose_estimates_t to_poses(const WaitingFrame& frame, const FrameAnswer& answer) {
  edgepose_lcm::pose_estimates_t m{};
  m.capture_utime = frame.depth.capture_utime;
  m.sequence = frame.depth.sequence;
  m.camera = frame.depth.camera;
  m.receive_utime = frame.receive_utime;
  m.preprocessing_seconds = answer.preprocessing_seconds;
  m.deadline_reached = answer.deadline_reached;
  for (const auto& [cause, count] : frame.dropped) m.dropped.push_back({cause, count});
  m.dropped_count = static_cast<int32_t>(m.dropped.size());
  for (const ModelAnswer& model : answer.models) m.answers.push_back(answer_message(model));
  m.answers_count = static_cast<int32_t>(m.answers.size());
  return m;
}

edgepose_lcm::drill_targets_t to_drill_targets(const WaitingFrame& frame, const FrameAnswer& answer) {
  edgepose_lcm::drill_targets_t m{};
  m.capture_utime = frame.depth.capture_utime;
  m.sequence = frame.depth.sequence;
  m.camera = frame.depth.camera;
  for (const ModelAnswer& model : answer.models) {
    if (!model.model->plan) continue;
    const auto placed =
        place_targets(*model.model->plan, model.result.detections, model.model->model.centre());
    for (const PlacedTarget& target : placed) m.targets.push_back(target_message(target, *model.model));
  }
  m.targets_count = static_cast<int32_t>(m.targets.size());
  return m;
}

}  // namespace edgepose
