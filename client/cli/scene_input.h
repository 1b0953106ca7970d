#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/mesh_file.h"
#include "matcher/scene.h"

namespace edgepose {

/// Where the options say the scene is: a depth image with its camera, or a cloud.
struct SceneSource {
  std::filesystem::path depth;
  std::string intrinsics;  ///< file or "fx,fy,cx,cy"
  int image_id = 0;        ///< entry of a BOP scene_camera.json
  bool image_id_given = false;
  double depth_scale = 0;  ///< [mm per unit]; 0 = as the intrinsics file says, else 1
  std::filesystem::path cloud;
  std::vector<double> viewpoint;  ///< x, y, z in `unit`, in the cloud's frame; empty = as the file says
};

/// A depth image, and the frame that results are reported in.
struct SceneInput {
  DepthImage image;
  Camera camera;
  RigidTransform frame_T_camera = RigidTransform::Identity();
  std::string frame = "camera";  ///< or "cloud"
  std::string file;
};

/// Adds --depth, --intrinsics, --image-id, --depth-scale, --cloud and --viewpoint; `source` must outlive the
/// app.
void add_scene_options(CLI::App& command, SceneSource& source);

/// Prepares it for matching. Throws InputError that names the file; if nothing measured is within the
/// options' depth range, with the range that was found.
Scene prepare(const SceneInput& input, const SceneOptions& options);

/// Reads it. `unit` is that of the cloud and its viewpoint. Warnings go to stderr.
/// Throws InputError for bad files, and where the options contradict each other.
SceneInput read_scene(const SceneSource& source, LengthUnit unit);

}  // namespace edgepose
