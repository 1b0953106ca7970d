#include "files/camera_file.h"

#include <algorithm>
#include <cmath>

#include "fuzz/input_check.h"

namespace {

using namespace edgepose;

void check(const CameraFile& file) {
  const bool sized = file.width && file.height;
  const double side = sized ? std::max(*file.width, *file.height) : 1e5;
  for (const double value : {file.camera.fx, file.camera.fy})
    must_hold(value > 0 && value <= 100 * std::max(1e4, side));
  for (const double value : {file.camera.cx, file.camera.cy}) must_hold(std::abs(value) <= 10 * side);
  must_hold(file.depth_scale > 0 && file.depth_scale <= 0.1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text = text_of(data, size);
  reads([&] { check(parse_camera_file(text, "camera")); });
  reads([&] { check(parse_camera_file(text, "camera", 3)); });
  reads([&] { check(parse_camera_values(text)); });
  return 0;
}
