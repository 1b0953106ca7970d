#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// What a file says about a depth camera.
struct CameraFile {
  Camera camera;
  std::optional<int> width, height;   ///< pixels, if the file tells
  double depth_scale = 0.001;         ///< [m] per unit of the depth image
  bool depth_scale_given = false;     ///< false: the file does not tell, the default stands
  std::vector<std::string> warnings;  ///< one line each: what was ignored, for the user
};

/// Reads intrinsics from `spec`: a BOP scene_camera.json (the entry of `image_id`; not needed if all entries
/// are equal), a BOP camera.json, a ROS camera_info YAML (as camera_calibration saves it, or as `rostopic
/// echo` prints it), or the text "fx,fy,cx,cy" in pixels. BOP's depth_scale is in millimetres per unit.
/// Throws InputError if it is none of these, a value is missing, zero, negative or NaN, or the image is not
/// listed.
CameraFile read_camera(const std::string& spec, std::optional<int> image_id = {});

/// The same from the content of a file; `name` stands in messages.
CameraFile parse_camera_file(std::string_view text, const std::string& name,
                             std::optional<int> image_id = {});

/// "fx,fy,cx,cy".
CameraFile parse_camera_values(std::string_view text);

}  // namespace edgepose
