#include "client/cli/render_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "common/error.h"
#include "files/json_node.h"
#include "files/rigid_values.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr size_t kMaxObjects = 1000;

PlacedMesh parse_object(const JsonNode& node, const std::filesystem::path& folder) {
  PlacedMesh object;
  object.mesh = folder / node.at("mesh").text();
  object.camera_T_model =
      rigid_from_row_major(node.at("cam_R_m2c").numbers(9), node.at("cam_t_m2c").numbers(3), node.where());
  if (const auto id = node.find("obj_id")) object.object_id = id->integer();
  return object;
}

}  // namespace

RigidTransform parse_pose(const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream stream(spaced);
  stream.imbue(std::locale::classic());
  Eigen::Matrix<double, 6, 1> values;
  int count = 0;
  for (double value; stream >> value; ++count) {
    if (count < 6) values[count] = value;
  }
  if (count != 6 || !stream.eof() || !values.allFinite()) {
    throw InputError::at("--pose", "six numbers \"x y z rx ry rz\" (mm, degrees)", "'" + text + "'");
  }
  const Eigen::Vector3d turn = values.tail<3>() * std::numbers::pi / 180;
  if (values.head<3>().norm() > 1000 * kMaxTranslation) {
    throw InputError::at("--pose", "a position within 1 km", "'" + text + "'", "give millimetres");
  }
  RigidTransform pose = RigidTransform::Identity();
  if (turn.norm() > 0) pose.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  pose.translation() = values.head<3>() / 1000;
  return pose;
}

std::vector<PlacedMesh> read_scene_file(const std::filesystem::path& path, std::optional<int> image) {
  return parse_scene_file(read_whole_file(path, "a scene file", kMaxJsonBytes), path, image);
}

std::vector<PlacedMesh> parse_scene_file(std::string_view text, const std::filesystem::path& file,
                                         std::optional<int> image) {
  const nlohmann::json json = parse_json(text, file.string());
  const JsonNode root(json, file.string());
  const std::vector<std::string> images = root.keys();
  if (images.empty()) root.fail("an image with its objects");
  if (!image && images.size() > 1) {
    root.fail("one image", "choose one of its " + std::to_string(images.size()) + " by --image");
  }
  std::vector<PlacedMesh> objects;
  for (const JsonNode& node : root.at(image ? std::to_string(*image) : images.front()).items()) {
    if (objects.size() == kMaxObjects) root.fail("at most " + std::to_string(kMaxObjects) + " objects");
    objects.push_back(parse_object(node, file.parent_path()));
  }
  if (objects.empty()) root.fail("at least one object");
  return objects;
}

std::string scene_file_text(const std::vector<PlacedMesh>& objects, const std::filesystem::path& folder) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PlacedMesh& object : objects) {
    nlohmann::ordered_json rotation = nlohmann::ordered_json::array();
    for (int i = 0; i < 9; ++i) rotation.push_back(object.camera_T_model.linear()(i / 3, i % 3));
    const Eigen::Vector3d t = object.camera_T_model.translation() * 1000;
    list.push_back(
        {{"cam_R_m2c", rotation},
         {"cam_t_m2c", {t.x(), t.y(), t.z()}},
         {"obj_id", object.object_id},
         {"mesh", std::filesystem::proximate(object.mesh, folder.empty() ? "." : folder).string()}});
  }
  return nlohmann::ordered_json{{"0", list}}.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) +
         "\n";
}

}  // namespace edgepose
