#include "files/camera_file.h"
#include "fuzz/input_check.h"

namespace {

using namespace edgepose;

void check(const CameraFile& file) {
  for (const double value : {file.camera.fx, file.camera.fy, file.camera.cx, file.camera.cy})
    must_hold(value > 0 && value <= 1e6);
  must_hold(file.depth_scale > 0 && file.depth_scale <= 0.1);
  must_hold(!file.width || file.camera.cx < *file.width);
  must_hold(!file.height || file.camera.cy < *file.height);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text = text_of(data, size);
  reads([&] { check(parse_camera_file(text, "camera")); });
  reads([&] { check(parse_camera_file(text, "camera", 3)); });
  reads([&] { check(parse_camera_values(text)); });
  return 0;
}
