#include "files/camera_info_yaml.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "common/error.h"
#include "files/camera_check.h"
#include "files/number_text.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

constexpr const char* kExpectedInfo = "a ROS camera_info (camera_matrix: data: [9 values], or K: [9 values])";

/// The numbers of a list, or of the `data` list within (as camera_calibration writes matrices).
std::vector<double> numbers(const YAML::Node& node, const std::string& where) {
  const YAML::Node list = node.IsMap() ? node["data"] : node;
  if (!list || !list.IsSequence()) throw InputError::at(where, "a list of numbers", "none");
  if (list.size() > 64)
    throw InputError::at(where, "a list of at most 64 numbers", std::to_string(list.size()));
  std::vector<double> values;
  for (const YAML::Node& item : list) {
    const auto value = item.IsScalar() ? finite_number(item.Scalar()) : std::nullopt;
    if (!value)
      throw InputError::at(where, "finite numbers",
                           item.IsScalar() ? edgepose::quoted(item.Scalar()) : "a nested list");
    values.push_back(*value);
  }
  return values;
}

/// The first of the keys that is there, with its name; an invalid node if none is.
std::pair<YAML::Node, std::string> first_of(const YAML::Node& map, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const YAML::Node node = map[key]) return {node, key};
  return {YAML::Node(YAML::NodeType::Undefined), ""};
}

std::optional<int> image_side(const YAML::Node& map, std::initializer_list<const char*> keys,
                              const std::string& name) {
  const auto [node, key] = first_of(map, keys);
  if (!node) return std::nullopt;
  const auto pixels = node.IsScalar() ? identifier(node.Scalar()) : std::nullopt;
  if (!pixels)
    throw InputError::at(name + ": " + key, "pixels",
                         node.IsScalar() ? edgepose::quoted(node.Scalar()) : "no number");
  if (*pixels == 0) return std::nullopt;  // ROS drivers leave it 0 when they do not know
  return pixels;
}

CameraFile from_map(const YAML::Node& map, const std::string& name) {
  const auto [matrix, key] = first_of(map, {"camera_matrix", "K", "k"});
  if (!matrix) throw InputError::at(name, kExpectedInfo, "neither camera_matrix nor K");
  CameraFile file;
  file.width = image_side(map, {"image_width", "width"}, name);
  file.height = image_side(map, {"image_height", "height"}, name);
  const std::string where = name + ": " + key;
  const std::vector<double> values = numbers(matrix, where);
  // An uncalibrated ROS camera publishes K as nine zeros.
  if (std::all_of(values.begin(), values.end(), [](double value) { return value == 0; }))
    throw InputError::at(where, "the intrinsics of a calibrated camera", "zeros", "calibrate the camera");
  file.camera = camera_from_matrix(values, where);
  check_camera(file.camera, where, file.width, file.height);

  const auto [distortion, distortion_key] = first_of(map, {"distortion_coefficients", "D", "d"});
  if (distortion && !distortion.IsNull()) {
    const std::vector<double> terms = numbers(distortion, name + ": " + distortion_key);
    if (std::any_of(terms.begin(), terms.end(), [](double term) { return term != 0; }))
      file.warnings.emplace_back("lens distortion is ignored; give a rectified depth image");
  }
  return file;
}

}  // namespace

CameraFile parse_camera_info(std::string_view text, const std::string& name) {
  try {
    const YAML::Node root = YAML::Load(std::string(text));
    if (!root.IsMap()) throw InputError::at(name, kExpectedInfo, "no YAML map");
    return from_map(root, name);
  } catch (const YAML::Exception& error) {
    throw InputError::at(name, kExpectedInfo,
                         "line " + std::to_string(error.mark.line + 1) + ": " + printable(error.msg),
                         "the file is cut short or damaged, or is not YAML");
  }
}

}  // namespace edgepose
