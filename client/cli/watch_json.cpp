#include <nlohmann/json.hpp>

#include "client/cli/watch_report.h"

namespace edgepose {
namespace {

using nlohmann::json;
using namespace edgepose_lcm;

json pose_json(const rigid_transform_t& pose) {
  return {{"quaternion_wxyz", pose.quaternion}, {"translation_m", pose.translation}};
}

json counters_json(const std::vector<counter_t>& counters) {
  json object = json::object();
  for (const counter_t& counter : counters) object[counter.name] = counter.value;
  return object;
}

json detection_json(const detection_t& detection) {
  json equivalent = json::array();
  for (const auto& pose : detection.camera_T_equivalent) equivalent.push_back(pose_json(pose));
  return {{"camera_T_model", pose_json(detection.camera_T_model)},
          {"covariance", detection.covariance},
          {"score", detection.score},
          {"accepted", detection.accepted},
          {"coverage", detection.coverage},
          {"violations", detection.violations},
          {"edge_score", detection.edge_score >= 0 ? json(detection.edge_score) : json()},
          {"margin", detection.margin},
          {"equivalent", equivalent}};
}

json answer_json(const model_answer_t& answer) {
  constexpr const char* kModes[] = {"detection", "tracking", "skipped"};
  json detections = json::array();
  for (const detection_t& detection : answer.detections) detections.push_back(detection_json(detection));
  return {{"model", answer.model},
          {"content_hash", answer.content_hash},
          {"mode", answer.mode >= 0 && answer.mode < 3 ? kModes[answer.mode] : "unknown"},
          {"reason", answer.reason},
          {"detections", detections},
          {"seconds",
           {{"sampling", answer.sampling_seconds},
            {"voting", answer.voting_seconds},
            {"clustering", answer.clustering_seconds},
            {"verification", answer.verification_seconds},
            {"refinement", answer.refinement_seconds}}}};
}

json target_json(const drill_target_t& target) {
  return {{"model", target.model},
          {"content_hash", target.content_hash},
          {"instance", target.instance},
          {"name", target.name},
          {"entry_m", target.entry},
          {"axis", target.axis},
          {"depth_m", target.depth},
          {"diameter_m", target.diameter},
          {"entry_sigma_m", target.entry_sigma},
          {"tip_sigma_m", target.tip_sigma},
          {"angle_sigma_rad", target.angle_sigma},
          {"position_tolerance_m", target.position_tolerance},
          {"angle_tolerance_rad", target.angle_tolerance},
          {"go", target.go != 0},
          {"reason", target.reason}};
}

}  // namespace

json to_json(const pose_estimates_t& answer, int64_t receive_utime) {
  json models = json::array();
  for (const model_answer_t& model : answer.answers) models.push_back(answer_json(model));
  return {{"type", "poses"},
          {"camera", answer.camera},
          {"sequence", answer.sequence},
          {"capture_utime", answer.capture_utime},
          {"send_utime", answer.send_utime},
          {"receive_utime", receive_utime},
          {"latency_seconds", latency(answer.capture_utime, receive_utime)},
          {"preprocessing_seconds", answer.preprocessing_seconds},
          {"deadline_reached", answer.deadline_reached != 0},
          {"dropped", counters_json(answer.dropped)},
          {"models", models}};
}

json to_json(const drill_targets_t& message, int64_t receive_utime) {
  json targets = json::array();
  for (const drill_target_t& target : message.targets) targets.push_back(target_json(target));
  return {{"type", "drill_targets"},
          {"camera", message.camera},
          {"sequence", message.sequence},
          {"capture_utime", message.capture_utime},
          {"send_utime", message.send_utime},
          {"receive_utime", receive_utime},
          {"targets", targets}};
}

json to_json(const service_status_t& status, int64_t receive_utime) {
  return {{"type", "status"},
          {"send_utime", status.send_utime},
          {"receive_utime", receive_utime},
          {"uptime_seconds", status.uptime},
          {"version", status.version},
          {"latency_p50_seconds", status.latency_p50},
          {"latency_p99_seconds", status.latency_p99},
          {"models", status.models},
          {"counters", counters_json(status.counters)}};
}

}  // namespace edgepose
