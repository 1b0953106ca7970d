#include "files/camera_file.h"

#include <algorithm>
#include <filesystem>

#include "files/bop_json.h"
#include "files/camera_check.h"
#include "files/camera_info_yaml.h"
#include "files/depth_file.h"
#include "files/json_node.h"
#include "files/number_text.h"
#include "files/text_cursor.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr const char* kExpectedCamera =
    "camera intrinsics (a BOP scene_camera.json or camera.json, a ROS camera_info YAML, or fx,fy,cx,cy)";
constexpr size_t kMaxYamlBytes = 1u << 20;

/// BOP's camera.json: one camera for the whole set.
CameraFile from_camera_json(const JsonNode& root) {
  CameraFile file;
  file.camera = {root.at("fx").number(), root.at("fy").number(), root.at("cx").number(),
                 root.at("cy").number()};
  if (const auto width = root.find("width")) file.width = width->integer();
  if (const auto height = root.find("height")) file.height = height->integer();
  check_camera(file.camera, root.where(), file.width, file.height);
  if (const auto scale = root.find("depth_scale")) {
    file.depth_scale = scale->number() * 1e-3;
    file.depth_scale_given = true;
    if (!(file.depth_scale >= kMinDepthScale && file.depth_scale <= kMaxDepthScale))
      scale->fail("a depth scale of 1e-4 to 100 millimetres per unit");
  }
  return file;
}

bool same(const BopCamera& a, const BopCamera& b) {
  const Camera &p = a.camera, &q = b.camera;
  return p.fx == q.fx && p.fy == q.fy && p.cx == q.cx && p.cy == q.cy && a.depth_scale == b.depth_scale;
}

CameraFile from_scene_camera(const std::map<int, BopCamera>& cameras, const std::string& name,
                             std::optional<int> image_id) {
  auto chosen = cameras.begin();
  if (image_id) {
    chosen = cameras.find(*image_id);
    if (chosen == cameras.end())
      throw InputError::at(name, "image " + std::to_string(*image_id),
                           std::to_string(cameras.size()) + " other images, " +
                               std::to_string(cameras.begin()->first) + " to " +
                               std::to_string(cameras.rbegin()->first));
  } else if (!std::all_of(cameras.begin(), cameras.end(),
                          [&](const auto& entry) { return same(entry.second, chosen->second); })) {
    throw InputError::at(name, "the number of the image, because its cameras differ", "none",
                         "name the depth image by its number, as BOP does (000012.png)");
  }
  CameraFile file;
  file.camera = chosen->second.camera;
  file.depth_scale = chosen->second.depth_scale;
  file.depth_scale_given = true;
  return file;
}

CameraFile from_json(std::string_view text, const std::string& name, std::optional<int> image_id) {
  const nlohmann::json json = parse_json(text, name);
  const JsonNode root(json, name);
  const std::vector<std::string> keys = root.keys();
  const bool one_camera = std::any_of(keys.begin(), keys.end(), [](const auto& key) {
    return key == "fx" || key == "fy" || key == "cx" || key == "cy";
  });
  if (one_camera) return from_camera_json(root);
  const bool by_image =
      std::all_of(keys.begin(), keys.end(), [](const auto& key) { return identifier(key); });
  if (!by_image)
    throw InputError::at(name, kExpectedCamera,
                         "JSON with other members (" + edgepose::quoted(keys.front()) + ")");
  return from_scene_camera(parse_bop_cameras(text, name), name, image_id);
}

}  // namespace

CameraFile parse_camera_values(std::string_view text) {
  const std::string where = "intrinsics " + edgepose::quoted(text);
  const std::string expected = "4 numbers fx,fy,cx,cy";
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 4) throw InputError::at(where, expected, std::to_string(parts.size()));
  double values[4];
  for (size_t i = 0; i < 4; ++i) {
    const auto value = finite_number(parts[i]);
    if (!value) throw InputError::at(where, expected, edgepose::quoted(trim(parts[i])));
    values[i] = *value;
  }
  CameraFile file;
  file.camera = {values[0], values[1], values[2], values[3]};
  check_camera(file.camera, where);
  return file;
}

CameraFile parse_camera_file(std::string_view text, const std::string& name, std::optional<int> image_id) {
  const std::string_view content = trim(text);
  if (content.empty()) throw InputError::at(name, kExpectedCamera, "an empty file");
  if (content.front() == '{') return from_json(text, name, image_id);
  if (text.size() > kMaxYamlBytes)
    throw InputError::at(name, kExpectedCamera, "a file of " + std::to_string(text.size()) + " bytes");
  // Binary files are told at once: a YAML parser's complaint would help nobody.
  if (text.find('\0') != std::string_view::npos) throw InputError::at(name, kExpectedCamera, "a binary file");
  return parse_camera_info(text, name);
}

CameraFile read_camera(const std::string& spec, std::optional<int> image_id) {
  std::error_code ignored;
  const bool is_file = std::filesystem::exists(spec, ignored);
  if (!is_file && spec.find(',') != std::string::npos) return parse_camera_values(spec);
  return parse_camera_file(read_whole_file(spec, kExpectedCamera, kMaxJsonBytes), spec, image_id);
}

}  // namespace edgepose
