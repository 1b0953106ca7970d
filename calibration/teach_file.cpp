#include "calibration/teach_file.h"

#include <set>

#include "calibration/transform_json.h"
#include "common/atomic_file.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr size_t kMaxTaughtBytes = 64u << 20;
constexpr size_t kMaxReferences = 1000, kMaxPoses = 100000;
constexpr double kMaxInModel = 5.0;     // [m] models are up to 5 m large
constexpr double kMaxFromModel = 10.0;  // [m] of a depth camera
constexpr double kMaxTool = 2.0;        // [m] of the tool from the camera: both are on the flange

TaughtReference reference_from(const JsonNode& node) {
  TaughtReference reference;
  reference.name = name_from(node.at("name"));
  reference.model_T_tool = transform_from(node.at("model_T_tool"), kMaxInModel);
  const JsonNode poses = node.at("camera_T_model");
  const std::vector<JsonNode> items = poses.items();
  if (items.empty() || items.size() > kMaxPoses) poses.fail("1 to 100000 poses");
  for (const JsonNode& pose : items) reference.camera_T_model.push_back(transform_from(pose, kMaxFromModel));
  return reference;
}

TaughtTool::Residual taught_residual(const JsonNode& node) {
  TaughtTool::Residual residual;
  residual.name = name_from(node.at("name"));
  residual.poses = node.at("poses").integer();
  if (residual.poses < 1) node.at("poses").fail("at least 1");
  residual.translation = residual_from(node.at("residual_m"));
  residual.rotation = residual_from(node.at("residual_rad"));
  residual.noise = {residual_from(node.at("noise_m")), residual_from(node.at("noise_rad"))};
  return residual;
}

nlohmann::ordered_json taught_residual_json(const TaughtTool::Residual& residual) {
  nlohmann::ordered_json json;
  json["name"] = residual.name;
  json["poses"] = residual.poses;
  json["residual_m"] = residual.translation;
  json["residual_rad"] = residual.rotation;
  json["noise_m"] = residual.noise.translation;
  json["noise_rad"] = residual.noise.rotation;
  return json;
}

std::vector<JsonNode> references_of(const JsonNode& root) {
  const JsonNode node = root.at("references");
  std::vector<JsonNode> items = node.items();
  if (items.empty() || items.size() > kMaxReferences) node.fail("1 to 1000 references");
  return items;
}

}  // namespace

TeachRecord parse_teach_record(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  const JsonNode root(json, name);
  check_kind(root, "teach-record");
  TeachRecord record;
  record.model = name_from(root.at("model"));
  std::set<std::string> names;
  for (const JsonNode& node : references_of(root)) {
    record.references.push_back(reference_from(node));
    if (!names.insert(record.references.back().name).second)
      node.at("name").fail("another name for each reference");
  }
  return record;
}

TeachRecord read_teach_record(const std::filesystem::path& path) {
  return parse_teach_record(read_whole_file(path, "a teaching record (JSON)", kMaxTaughtBytes),
                            path.string());
}

TaughtFile parse_taught(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  const JsonNode root(json, name);
  check_kind(root, "taught-tool");
  TaughtFile file;
  file.made = time_from(root.at("made"));
  file.model = name_from(root.at("model"));
  file.taught.camera_T_tool = transform_from(root.at("camera_T_tool"), kMaxTool);
  for (const JsonNode& node : references_of(root)) file.taught.residuals.push_back(taught_residual(node));
  return file;
}

TaughtFile read_taught(const std::filesystem::path& path) {
  return parse_taught(read_whole_file(path, "a taught tool (JSON)", kMaxTaughtBytes), path.string());
}

std::string format_taught(const TaughtFile& file) {
  nlohmann::ordered_json json;
  json["kind"] = "taught-tool";
  json["made"] = file.made;
  json["model"] = file.model;
  json["camera_T_tool"] = transform_json(file.taught.camera_T_tool);
  json["references"] = nlohmann::ordered_json::array();
  for (const TaughtTool::Residual& residual : file.taught.residuals)
    json["references"].push_back(taught_residual_json(residual));
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write_taught(const std::filesystem::path& path, const TaughtFile& file) {
  write_file_atomically(path, std::string_view(format_taught(file)));
}

}  // namespace edgepose
