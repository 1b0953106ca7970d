#include "client/cli/scene_input.h"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <limits>

#include "client/cli/option_checks.h"
#include "common/error.h"
#include "common/naming.h"
#include "files/camera_check.h"
#include "files/camera_file.h"
#include "files/depth_file.h"
#include "files/number_text.h"

namespace edgepose {
namespace {

/// "000012.png" is image 12, as BOP names them; nothing for other names.
std::optional<int> number_in_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  int number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (error != std::errc{} || end != stem.data() + stem.size()) return std::nullopt;
  return number;
}

/// The camera of `source`: that of the given image, else the one that all images share, else that of the
/// image which the depth file is named after.
CameraFile read_its_camera(const SceneSource& source) {
  if (source.image_id_given) return read_camera(source.intrinsics, source.image_id);
  try {
    return read_camera(source.intrinsics);
  } catch (const InputError&) {
    const std::optional<int> number = number_in_name(source.depth);
    if (!number) throw;
    return read_camera(source.intrinsics, number);
  }
}

SceneInput read_depth(const SceneSource& source) {
  if (source.intrinsics.empty()) {
    throw InputError(
        "--depth needs --intrinsics: fx,fy,cx,cy, a BOP scene_camera.json or a ROS camera_info YAML");
  }
  const CameraFile camera = read_its_camera(source);
  SceneInput scene;
  scene.file = source.depth.string();
  scene.camera = camera.camera;
  scene.image =
      read_depth_png(source.depth, source.depth_scale > 0 ? 1e-3 * source.depth_scale : camera.depth_scale);
  check_camera(scene.camera, source.intrinsics, scene.image.width, scene.image.height);
  std::vector<std::string> warnings = camera.warnings;
  warnings.push_back(off_centre_warning(scene.camera, scene.image.width, scene.image.height));
  for (const std::string& warning : warnings)
    if (!warning.empty()) std::cerr << source.intrinsics << ": warning: " << warning << '\n';
  if (camera.width && camera.height &&
      (*camera.width != scene.image.width || *camera.height != scene.image.height)) {
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    throw InputError::at(
        scene.file,
        "an image of " + size(*camera.width, *camera.height) + " as " + source.intrinsics + " says",
        size(scene.image.width, scene.image.height), "give the intrinsics of this resolution");
  }
  return scene;
}

SceneInput read_projected_cloud(const SceneSource& source, LengthUnit unit) {
  const Cloud cloud = read_cloud(source.cloud, unit);
  Eigen::Vector3f viewpoint = cloud.viewpoint;
  if (!source.viewpoint.empty()) {
    viewpoint = (metres_per(unit) * Eigen::Vector3d(source.viewpoint.data())).cast<float>();
    if (!viewpoint.allFinite()) throw InputError::at("--viewpoint", "finite numbers", "NaN or infinity");
  }
  SceneInput scene;
  scene.file = source.cloud.string();
  ProjectedCloud projected = naming(scene.file, [&] { return project_cloud(cloud.vertices, viewpoint); });
  scene.image = std::move(projected.image);
  scene.camera = projected.camera;
  scene.frame_T_camera = projected.cloud_T_camera;
  scene.frame = "cloud";
  return scene;
}

}  // namespace

Scene prepare(const SceneInput& input, const SceneOptions& options) {
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (const float depth : input.image.depth) {
    if (!(depth > 0)) continue;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  const auto text = [](float metres) { return number_text(static_cast<double>(metres), 3); };
  if (options.check().empty() && (nearest > options.max_depth || farthest < options.min_depth)) {
    throw InputError::at(
        input.file, "measurements from " + text(options.min_depth) + " to " + text(options.max_depth) + " m",
        "only such from " + text(nearest) + " to " + text(farthest) + " m",
        std::string("check ") + (input.frame == "camera" ? "--depth-scale" : "--unit") +
            ", or widen scene.min_depth and max_depth with --config");
  }
  return naming(input.file, [&] { return prepare_scene(input.image, input.camera, options); });
}

void add_scene_options(CLI::App& command, SceneSource& source) {
  auto* depth = command.add_option("--depth", source.depth, "Depth image: 16-bit PNG, 0 = no measurement");
  auto* intrinsics =
      command.add_option("--intrinsics", source.intrinsics,
                         "Its camera: fx,fy,cx,cy in pixels, BOP scene_camera.json, or ROS camera_info YAML");
  command
      .add_option_function<int>(
          "--image-id",
          [&source](int id) {
            source.image_id = id;
            source.image_id_given = true;
          },
          "Image in scene_camera.json (default: the number that the depth file is named after)")
      ->needs(intrinsics);
  command
      .add_option("--depth-scale", source.depth_scale, "Millimetres per unit of the depth image (default 1)")
      ->check(number_between(1e3 * kMinDepthScale, 1e3 * kMaxDepthScale))
      ->needs(depth);
  auto* cloud =
      command.add_option("--cloud", source.cloud, "Unorganised cloud (PLY, PCD) instead of a depth image");
  command
      .add_option("--viewpoint", source.viewpoint, "Where the cloud was seen from, in its own frame and unit")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z")
      ->needs(cloud);
  intrinsics->needs(depth);
  cloud->excludes(depth);
}

SceneInput read_scene(const SceneSource& source, LengthUnit unit) {
  if (!source.depth.empty()) return read_depth(source);
  if (!source.cloud.empty()) return read_projected_cloud(source, unit);
  throw InputError("give a scene: --depth IMAGE.png --intrinsics CAMERA, or --cloud CLOUD.ply");
}

}  // namespace edgepose
