#pragma once
#include <unistd.h>

#include <filesystem>
#include <sstream>

#include "common/atomic_file.h"
#include "files/depth_file.h"
#include "files/mesh_file.h"
#include "files/test_set.h"
#include "render/depth_renderer.h"

namespace edgepose {

inline void add_box(Mesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  const uint32_t first = static_cast<uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                               i & 4 ? high.z() : low.z());
  constexpr uint32_t kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& f : kFaces) mesh.triangles.push_back({first + f[0], first + f[1], first + f[2]});
}

/// A small BOP set on disk that needs no data from elsewhere: two stepped blocks of about 0.2 m. Image 0
/// shows both side by side, image 1 only the first.
class RenderedSet {
 public:
  RenderedSet()
      : folder(std::filesystem::temp_directory_path() / ("edgepose_set_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "models");
    std::filesystem::create_directories(folder / "test" / "000001" / "depth");
    Mesh stairs, tower;
    add_box(stairs, {-0.08f, -0.05f, -0.04f}, {0.08f, 0.05f, 0});
    add_box(stairs, {-0.08f, -0.05f, 0}, {-0.02f, 0.05f, 0.05f});
    add_box(stairs, {-0.02f, 0.01f, 0}, {0.04f, 0.05f, 0.03f});
    add_box(tower, {-0.03f, -0.03f, -0.08f}, {0.03f, 0.03f, 0.08f});
    add_box(tower, {0.03f, -0.03f, -0.08f}, {0.09f, 0.01f, -0.03f});
    add_box(tower, {-0.03f, 0.03f, 0.02f}, {0.02f, 0.07f, 0.08f});
    write_ply(folder / "models" / "obj_000001.ply", stairs);
    write_ply(folder / "models" / "obj_000002.ply", tower);
    write_file_atomically(
        folder / "models" / "models_info.json",
        R"({"1": {"name": "stairs", "diameter": 200}, "2": {"name": "tower", "diameter": 210}})");
    const RigidTransform left = pose(-0.12, 0.4), right = pose(0.14, 1.9), middle = pose(0.05, 2.2);
    write_image(0, {{stairs, left}, {tower, right}});
    write_image(1, {{stairs, middle}});
    const std::filesystem::path scene = folder / "test" / "000001";
    const std::string camera = R"({"cam_K": [500, 0, 159.5, 0, 500, 119.5, 0, 0, 1], "depth_scale": 0.1})";
    write_file_atomically(scene / "scene_camera.json", "{\"0\": " + camera + ", \"1\": " + camera + "}");
    write_file_atomically(scene / "scene_gt.json", "{\"0\": [" + truth(1, left) + ", " + truth(2, right) +
                                                       "], \"1\": [" + truth(1, middle) + "]}");
    const std::string visible = R"({"px_count_visib": 5000, "visib_fract": 1.0})";
    write_file_atomically(scene / "scene_gt_info.json",
                          "{\"0\": [" + visible + ", " + visible + "], \"1\": [" + visible + "]}");
    set = read_test_set(folder);
  }
  ~RenderedSet() { std::filesystem::remove_all(folder); }
  RenderedSet(const RenderedSet&) = delete;
  RenderedSet& operator=(const RenderedSet&) = delete;

  std::filesystem::path folder;
  TestSet set;

 private:
  static RigidTransform pose(double x, double angle) {
    RigidTransform camera_T_model(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 0.5).normalized()));
    camera_T_model.translation() = Eigen::Vector3d(x, 0.02, 0.8);
    return camera_T_model;
  }
  static std::string truth(int object, const RigidTransform& pose) {
    std::ostringstream text;
    text.precision(12);
    text << "{\"obj_id\": " << object << ", \"cam_R_m2c\": [";
    for (int i = 0; i < 9; ++i) text << (i ? ", " : "") << pose.linear()(i / 3, i % 3);
    text << "], \"cam_t_m2c\": [";
    for (int i = 0; i < 3; ++i) text << (i ? ", " : "") << 1e3 * pose.translation()[i];
    text << "]}";
    return text.str();
  }
  void write_image(int id, const std::vector<std::pair<Mesh, RigidTransform>>& objects) {
    DepthRenderer renderer;
    for (const auto& [mesh, camera_T_model] : objects) renderer.add(mesh, camera_T_model);
    const Camera camera{500, 500, 159.5, 119.5};
    write_depth_png(folder / "test" / "000001" / "depth" / ("00000" + std::to_string(id) + ".png"),
                    renderer.render(camera, 320, 240).depth, 1e-4);
  }
};

}  // namespace edgepose
