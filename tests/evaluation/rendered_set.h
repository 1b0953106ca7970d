#pragma once
#include <unistd.h>

#include <filesystem>

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

/// A small test set on disk that needs no data from elsewhere: two stepped blocks of about 0.2 m. Image 0
/// shows both side by side, image 1 only the first.
class RenderedSet {
 public:
  RenderedSet()
      : folder_(std::filesystem::temp_directory_path() / ("edgepose_set_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    set.name = "rendered";
    Mesh stairs, tower;
    add_box(stairs, {-0.08f, -0.05f, -0.04f}, {0.08f, 0.05f, 0});
    add_box(stairs, {-0.08f, -0.05f, 0}, {-0.02f, 0.05f, 0.05f});
    add_box(stairs, {-0.02f, 0.01f, 0}, {0.04f, 0.05f, 0.03f});
    add_box(tower, {-0.03f, -0.03f, -0.08f}, {0.03f, 0.03f, 0.08f});
    add_box(tower, {0.03f, -0.03f, -0.08f}, {0.09f, 0.01f, -0.03f});
    add_box(tower, {-0.03f, 0.03f, 0.02f}, {0.02f, 0.07f, 0.08f});
    add_object(1, "stairs", stairs, 0.20);
    add_object(2, "tower", tower, 0.21);
    add_image(0, {truth(1, -0.12, 0.4), truth(2, 0.14, 1.9)}, {stairs, tower});
    add_image(1, {truth(1, 0.05, 2.2)}, {stairs});
  }
  ~RenderedSet() { std::filesystem::remove_all(folder_); }
  RenderedSet(const RenderedSet&) = delete;
  RenderedSet& operator=(const RenderedSet&) = delete;

  TestSet set;

 private:
  static GroundTruth truth(int object, double x, double angle) {
    GroundTruth truth;
    truth.object_id = object;
    truth.camera_T_model.linear() =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 0.5).normalized()).toRotationMatrix();
    truth.camera_T_model.translation() = Eigen::Vector3d(x, 0.02, 0.8);
    return truth;
  }
  void add_object(int id, const std::string& name, const Mesh& mesh, double diameter) {
    TestObject object;
    object.id = id;
    object.name = name;
    object.mesh = folder_ / (name + ".ply");
    object.diameter = diameter;
    write_ply(object.mesh, mesh);
    set.objects.push_back(object);
  }
  void add_image(int id, std::vector<GroundTruth> truths, const std::vector<Mesh>& meshes) {
    DepthRenderer renderer;
    for (size_t i = 0; i < meshes.size(); ++i) renderer.add(meshes[i], truths[i].camera_T_model);
    TestImage image;
    image.scene_id = 1;
    image.image_id = id;
    image.camera = {500, 500, 159.5, 119.5};
    image.depth_scale = 1e-4;
    image.depth = folder_ / (std::to_string(id) + ".png");
    image.truth = std::move(truths);
    write_depth_png(image.depth, renderer.render(image.camera, 320, 240).depth, image.depth_scale);
    set.images.push_back(image);
  }

  std::filesystem::path folder_;
};

}  // namespace edgepose
