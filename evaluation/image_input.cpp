#include "evaluation/image_input.h"

#include <chrono>

#include "common/naming.h"
#include "files/camera_check.h"
#include "files/depth_file.h"
#include "files/mesh_file.h"

namespace edgepose {

ImageInput read_image_input(const TestImage& image) {
  ImageInput input;
  if (image.cloud.empty()) {
    input.file = image.depth.string();
    input.depth = read_depth_png(image.depth, image.depth_scale);
    input.camera = image.camera;
    check_camera(image.camera, "camera of " + input.file, input.depth.width, input.depth.height);
    return input;
  }
  input.file = image.cloud.string();
  const Cloud cloud = read_cloud(image.cloud, LengthUnit::kMillimetre);
  const auto start = std::chrono::steady_clock::now();
  ProjectedCloud projected =
      naming(input.file, [&] { return project_cloud(cloud.vertices, cloud.viewpoint); });
  input.depth = std::move(projected.image);
  input.camera = projected.camera;
  input.truth_T_camera = projected.cloud_T_camera;
  input.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return input;
}

}  // namespace edgepose
