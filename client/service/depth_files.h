#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// A depth image that is to be sent, and the camera that it is of.
struct DepthFile {
  std::filesystem::path path;
  Camera camera;
  double depth_scale = 0.001;  ///< [m] per unit
  int width = 0, height = 0;   ///< [pixels] that the camera's file tells; 0 = does not tell
};

/// What the user says about the images.
struct DepthFileOptions {
  std::string intrinsics;  ///< "fx,fy,cx,cy" or a file (files/camera_file.h); may be empty for BOP folders
  double depth_scale = 0;  ///< [mm per unit]; 0 = as the file says, else 1
};

/// The images of each path, one path after the other: a PNG; a folder of them, by rising name; a scene folder
/// in the BOP format (scene_camera.json beside depth/), by rising image number; or a BOP set, by scene and
/// image. Throws InputError that names the file, also if a path has no image.
std::vector<DepthFile> find_depth_files(const std::vector<std::filesystem::path>& paths,
                                        const DepthFileOptions& options);

/// Reads the image. Throws InputError that names the file: no depth image, or not of this camera.
DepthImage read_depth_file(const DepthFile& file);

}  // namespace edgepose
