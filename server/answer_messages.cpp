#include "server/answer_messages.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/number_text.h"
#include "messaging/transform_message.h"
#include "planning/placed_target.h"
#include "planning/symmetry_doubt.h"

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

edgepose_lcm::detection_t detection_message(const Detection& detection) {
  edgepose_lcm::detection_t m{};
  m.camera_T_model = to_message(detection.camera_T_model);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) m.covariance[row][column] = detection.covariance(row, column);
  m.score = detection.score;
  m.accepted = detection.accepted;
  m.coverage = detection.coverage;
  m.violations = detection.violations;
  m.edge_score = detection.edge_score.value_or(-1);
  m.margin = detection.margin;
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
  for (const Detection& detection : result.detections) m.detections.push_back(detection_message(detection));
  m.detections_count = static_cast<int32_t>(m.detections.size());
  return m;
}

std::string millimetres(double metres) { return number_text(1e3 * metres, 3) + " mm"; }
std::string degrees(double radians) { return number_text(radians * 180 / std::numbers::pi, 3) + " degrees"; }

/// Why the hole must not be drilled, from what is known of this frame; empty: go.
std::string doubt(const PlacedTarget& placed, const ModelAnswer& model, const FrameAnswer& answer,
                  const TargetOptions& options) {
  const double sigma = std::max(placed.entry_sigma, placed.bottom_sigma);
  if (2 * sigma > placed.target.position_tolerance)
    return "position: two standard deviations are " + millimetres(2 * sigma) + ", the plan allows " +
           millimetres(placed.target.position_tolerance);
  if (2 * placed.angle_sigma > placed.target.angle_tolerance)
    return "angle: two standard deviations are " + degrees(2 * placed.angle_sigma) + ", the plan allows " +
           degrees(placed.target.angle_tolerance);
  if (!placed.certain) return "the pose's uncertainty is not known";
  if (answer.deadline_reached)
    return "the deadline came before every model was looked for: another may explain this place better";
  const double margin = model.result.detections[placed.instance].margin;
  if (margin < options.min_margin)
    return "a clearly different pose scores nearly as well: margin " + number_text(margin, 3) + ", wanted " +
           number_text(options.min_margin, 3) + " (targets.min_margin)";
  return "";
}

/// ... and from the plan alone: the model's symmetries.
std::string planning_doubt(const DrillTarget& planned, const RegisteredModel& model) {
  if (!is_ambiguous(planned, *model.plan, model.model.symmetries())) return "";
  return "the model looks the same in poses that put this hole elsewhere";
}

edgepose_lcm::drill_target_t target_message(const PlacedTarget& placed, const RegisteredModel& model,
                                            const std::string& reason) {
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
  m.reason = reason;
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

edgepose_lcm::drill_targets_t to_drill_targets(const WaitingFrame& frame, const FrameAnswer& answer,
                                               const TargetOptions& options, double age) {
  edgepose_lcm::drill_targets_t m{};
  m.capture_utime = frame.depth.capture_utime;
  m.sequence = frame.depth.sequence;
  m.camera = frame.depth.camera;
  for (const ModelAnswer& found : answer.models) {
    const RegisteredModel& model = *found.model;
    if (!model.plan) continue;
    const auto placed = place_targets(*model.plan, found.result.detections, model.model.centre());
    for (size_t i = 0; i < placed.size(); ++i) {
      // place_targets() gives the plan's holes in their order, for one instance after the other.
      std::string reason = planning_doubt(model.plan->targets[i % model.plan->targets.size()], model);
      if (reason.empty()) reason = doubt(placed[i], found, answer, options);
      if (age > options.max_age)
        reason = "the frame was taken " + number_text(age, 3) + " s ago (frames.max_age)";
      m.targets.push_back(target_message(placed[i], model, reason));
    }
  }
  m.targets_count = static_cast<int32_t>(m.targets.size());
  return m;
}

}  // namespace edgepose
