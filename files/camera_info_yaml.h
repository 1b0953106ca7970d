#pragma once
#include <string>
#include <string_view>

#include "files/camera_file.h"

namespace edgepose {

/// ROS camera_info as YAML (yaml-cpp stays behind this border). Throws InputError led by `name`.
CameraFile parse_camera_info(std::string_view text, const std::string& name);

}  // namespace edgepose
