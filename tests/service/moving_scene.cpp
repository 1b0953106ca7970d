#include "tests/service/moving_scene.h"

#include <cmath>

#include "files/mesh_file.h"
#include "render/depth_renderer.h"
#include "render/sensor_model.h"

namespace edgepose::test {
namespace {

constexpr Camera kCamera{252, 252, 159.5, 143.5};
constexpr int kWidth = 320, kHeight = 288;

/// A square of half a metre, 5 cm behind the phantom.
Mesh table() {
  Mesh mesh;
  mesh.vertices = {
      {-0.25f, -0.25f, 0.05f}, {0.25f, -0.25f, 0.05f}, {0.25f, 0.25f, 0.05f}, {-0.25f, 0.25f, 0.05f}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

RigidTransform pose_at(double step, double speed) {
  // A curve whose speed is `speed` a step at most, in all directions.
  const double phase = 0.1 * step, reach = speed / 0.1 / 2;
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Eigen::Vector3d(reach * std::sin(phase), reach * std::sin(0.7 * phase + 1),
                                       0.4 + reach * std::sin(0.5 * phase + 2));
  pose.linear() =
      (Eigen::AngleAxisd(3 * reach * std::sin(phase), Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(2.5 + 3 * reach * std::sin(0.8 * phase), Eigen::Vector3d(1, 2, 0.5).normalized()))
          .toRotationMatrix();
  return pose;
}

}  // namespace

std::vector<TrueFrame> moving_phantom(int count, double speed) {
  DepthRenderer renderer;
  const size_t phantom = renderer.add(read_mesh(phantom_file("phantom.ply")));
  RigidTransform camera_T_table = RigidTransform::Identity();
  camera_T_table.translation().z() = 0.42;
  renderer.add(table(), camera_T_table);
  SensorModel sensor = SensorModel::time_of_flight();
  std::vector<TrueFrame> frames;
  for (int i = 0; i < count; ++i) {
    TrueFrame frame;
    frame.camera_T_model = pose_at(i, speed);
    renderer.set_pose(phantom, frame.camera_T_model);
    frame.depth.camera = "test_camera";
    frame.depth.sequence = i + 1;
    frame.depth.intrinsics = kCamera;
    frame.depth.image = apply_sensor(renderer.render(kCamera, kWidth, kHeight).depth, kCamera, sensor,
                                     static_cast<uint64_t>(i) + 1);
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::filesystem::path phantom_file(const std::string& name) {
  return std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models/phantom" / name;
}

double distance(const RigidTransform& a, const RigidTransform& b, const Eigen::Vector3d& centre) {
  return (a * centre - b * centre).norm();
}

}  // namespace edgepose::test
