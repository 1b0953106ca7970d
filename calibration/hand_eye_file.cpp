#include "calibration/hand_eye_file.h"

#include "arm/kinematics.h"
#include "calibration/transform_json.h"
#include "common/atomic_file.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr size_t kMaxBytes = 16u << 20;
constexpr size_t kMaxSamples = 10000;
constexpr double kMaxReach = 2.0;   // [m] of an arm
constexpr double kMaxSight = 10.0;  // [m] of a depth camera

HandEyeSample sample_from(const JsonNode& node, const ArmGeometry& arm) {
  HandEyeSample sample;
  if (const auto joints = node.find("joints_rad"))
    sample.base_T_flange = base_T_flange(arm, joints_from(*joints));
  else
    sample.base_T_flange = transform_from(node.at("base_T_flange"), kMaxReach);
  sample.camera_T_target = transform_from(node.at("camera_T_target"), kMaxSight);
  return sample;
}

HandEyeResidual residual_at(const JsonNode& node) {
  return {residual_from(node.at("translation_m")), residual_from(node.at("rotation_rad"))};
}

nlohmann::ordered_json residual_json(const HandEyeResidual& residual) {
  nlohmann::ordered_json json;
  json["translation_m"] = residual.translation;
  json["rotation_rad"] = residual.rotation;
  return json;
}

std::string written(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<HandEyeSample> parse_hand_eye_samples(std::string_view text, const std::string& name,
                                                  const ArmGeometry& arm) {
  const nlohmann::json json = parse_json(text, name);
  const JsonNode root(json, name);
  check_kind(root, "hand-eye-samples");
  const std::vector<JsonNode> nodes = root.at("samples").items();
  if (nodes.empty() || nodes.size() > kMaxSamples) root.at("samples").fail("1 to 10000 samples");
  std::vector<HandEyeSample> samples;
  for (const JsonNode& node : nodes) samples.push_back(sample_from(node, arm));
  return samples;
}

std::vector<HandEyeSample> read_hand_eye_samples(const std::filesystem::path& path, const ArmGeometry& arm) {
  return parse_hand_eye_samples(read_whole_file(path, "hand-eye samples (JSON)", kMaxBytes), path.string(),
                                arm);
}

HandEyeFile parse_hand_eye(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  const JsonNode root(json, name);
  check_kind(root, "hand-eye");
  HandEyeFile file;
  file.made = time_from(root.at("made"));
  file.method = name_from(root.at("method"));
  file.flange_T_camera = transform_from(root.at("flange_T_camera"), kMaxOnFlange);
  file.samples = root.at("samples").integer();
  if (file.samples < 3) root.at("samples").fail("at least 3");
  file.rms = residual_at(root.at("residual_rms"));
  file.worst = residual_at(root.at("residual_worst"));
  return file;
}

HandEyeFile read_hand_eye(const std::filesystem::path& path) {
  return parse_hand_eye(read_whole_file(path, "a hand-eye calibration (JSON)", kMaxBytes), path.string());
}

std::string format_hand_eye(const HandEyeFile& file) {
  nlohmann::ordered_json json;
  json["kind"] = "hand-eye";
  json["made"] = file.made;
  json["method"] = file.method;
  json["flange_T_camera"] = transform_json(file.flange_T_camera);
  json["samples"] = file.samples;
  json["residual_rms"] = residual_json(file.rms);
  json["residual_worst"] = residual_json(file.worst);
  return written(json);
}

void write_hand_eye(const std::filesystem::path& path, const HandEyeFile& file) {
  write_file_atomically(path, std::string_view(format_hand_eye(file)));
}

ToolFile parse_tool(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  const JsonNode root(json, name);
  check_kind(root, "tool");
  return {time_from(root.at("made")), name_from(root.at("name")),
          transform_from(root.at("flange_T_tool"), kMaxOnFlange)};
}

ToolFile read_tool(const std::filesystem::path& path) {
  return parse_tool(read_whole_file(path, "a tool's calibration (JSON)", kMaxBytes), path.string());
}

std::string format_tool(const ToolFile& file) {
  nlohmann::ordered_json json;
  json["kind"] = "tool";
  json["made"] = file.made;
  json["name"] = file.name;
  json["flange_T_tool"] = transform_json(file.flange_T_tool);
  return written(json);
}

}  // namespace edgepose
