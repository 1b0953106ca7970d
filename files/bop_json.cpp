#include "files/bop_json.h"

#include <algorithm>
#include <cstdio>

#include "files/camera_check.h"
#include "files/depth_file.h"
#include "files/json_node.h"
#include "files/number_text.h"
#include "files/rigid_values.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

/// The members of an object whose keys are ids ("12", "000012"), by rising id.
std::vector<std::pair<int, JsonNode>> members_by_id(const JsonNode& object) {
  std::vector<std::pair<int, JsonNode>> members;
  for (const std::string& key : object.keys()) {
    const auto id = identifier(key);
    if (!id) throw InputError::at(object.where(), "ids as keys", edgepose::quoted(key));
    members.emplace_back(*id, object.at(key));
  }
  std::sort(members.begin(), members.end(), [](auto& a, auto& b) { return a.first < b.first; });
  for (size_t i = 1; i < members.size(); ++i)
    if (members[i].first == members[i - 1].first)
      throw InputError::at(object.where(), "each id once", std::to_string(members[i].first) + " twice");
  return members;
}

SymmetryAxis parse_axis(const JsonNode& node) {
  const auto offset = node.find("offset");
  return {offset ? Eigen::Vector3d(offset->vector() * 1e-3) : Eigen::Vector3d(0, 0, 0),
          node.at("axis").direction()};
}

Symmetries parse_symmetries(const JsonNode& object) {
  constexpr double kSame = 1e-6;
  Symmetries symmetries;
  if (const auto discrete = object.find("symmetries_discrete"))
    for (const JsonNode& node : discrete->items()) {
      const RigidTransform model_T_model = rigid_from_matrix(node.numbers(16), node.where());
      if (!model_T_model.isApprox(RigidTransform::Identity(), kSame))
        symmetries.discrete.push_back(model_T_model);
    }
  if (const auto continuous = object.find("symmetries_continuous"))
    for (const JsonNode& node : continuous->items()) symmetries.continuous.push_back(parse_axis(node));
  return symmetries;
}

double share(const JsonNode& node) {
  const double value = node.number();
  if (value < 0 || value > 1) node.fail("a share from 0 to 1");
  return value;
}

}  // namespace

std::vector<TestObject> parse_bop_objects(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  std::vector<TestObject> objects;
  for (const auto& [id, node] : members_by_id(JsonNode(json, name))) {
    TestObject object;
    object.id = id;
    char fallback[32];
    std::snprintf(fallback, sizeof(fallback), "obj_%06d", id);
    const auto given = node.find("name");
    object.name = given ? given->text() : fallback;
    object.diameter = node.at("diameter").positive() * 1e-3;
    if (object.diameter > kMaxTranslation)
      node.at("diameter").fail("a diameter in millimetres, at most 1 km");
    object.symmetries = parse_symmetries(node);
    object.symmetric = !object.symmetries.empty();
    objects.push_back(std::move(object));
  }
  if (objects.empty()) throw InputError::at(name, "at least one object", "none");
  return objects;
}

std::map<int, BopCamera> parse_bop_cameras(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  std::map<int, BopCamera> cameras;
  for (const auto& [id, node] : members_by_id(JsonNode(json, name))) {
    const JsonNode matrix = node.at("cam_K");
    BopCamera& camera = cameras[id];
    camera.camera = camera_from_matrix(matrix.numbers(9), matrix.where());
    check_camera(camera.camera, matrix.where());
    if (const auto scale = node.find("depth_scale")) {
      camera.depth_scale = scale->number() * 1e-3;
      if (!(camera.depth_scale >= kMinDepthScale && camera.depth_scale <= kMaxDepthScale))
        scale->fail("a depth scale of 1e-4 to 100 millimetres per unit");
    }
  }
  if (cameras.empty()) throw InputError::at(name, "at least one image", "none");
  return cameras;
}

std::map<int, std::vector<GroundTruth>> parse_bop_truth(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  std::map<int, std::vector<GroundTruth>> truth;
  for (const auto& [id, node] : members_by_id(JsonNode(json, name))) {
    std::vector<GroundTruth>& instances = truth[id];
    for (const JsonNode& item : node.items()) {
      GroundTruth& instance = instances.emplace_back();
      instance.object_id = item.at("obj_id").integer();
      instance.camera_T_model = rigid_from_row_major(item.at("cam_R_m2c").numbers(9),
                                                     item.at("cam_t_m2c").numbers(3), item.where());
    }
  }
  return truth;
}

void add_bop_visibility(std::string_view text, const std::string& name,
                        std::map<int, std::vector<GroundTruth>>& truth) {
  const nlohmann::json json = parse_json(text, name);
  for (const auto& [id, node] : members_by_id(JsonNode(json, name))) {
    const auto found = truth.find(id);
    if (found == truth.end()) continue;  // about an image without instances: harmless
    std::vector<GroundTruth>& instances = found->second;
    const std::vector<JsonNode> items = node.items();
    if (items.size() != instances.size())
      throw InputError::at(
          node.where(),
          "one entry for each of the " + std::to_string(instances.size()) + " instances in scene_gt.json",
          std::to_string(items.size()));
    for (size_t i = 0; i < items.size(); ++i) {
      if (const auto value = items[i].find("visib_fract")) instances[i].visible_share = share(*value);
      if (const auto value = items[i].find("px_count_visib")) instances[i].visible_pixels = value->integer();
      if (const auto value = items[i].find("occlusion")) instances[i].occlusion = share(*value);
    }
  }
}

}  // namespace edgepose
