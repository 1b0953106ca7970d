#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "files/bop_set.h"
#include "files/camera_file.h"
#include "files/depth_file.h"
#include "models/phantom/phantom_mesh.h"
#include "models/phantom/sample_scenes.h"
#include "render/depth_renderer.h"

namespace edgepose::phantom {
namespace {

const std::filesystem::path kModels = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models";

/// Share of the pixels that the phantom alone would cover where the image shows it: no nearer and no farther.
double agreement(const DepthImage& image, const RigidTransform& camera_T_model) {
  DepthRenderer renderer;
  renderer.add(phantom_mesh(), camera_T_model);
  const DepthImage alone = renderer.render(kSampleCamera, image.width, image.height).depth;
  int covered = 0, agreeing = 0;
  for (size_t i = 0; i < alone.depth.size(); ++i) {
    if (alone.depth[i] == 0) continue;
    ++covered;
    agreeing += std::abs(alone.depth[i] - image.depth[i]) < 0.004f;
  }
  return static_cast<double>(agreeing) / covered;
}

TEST(SampleSet, IsABopSetWhoseTruthFitsItsImages) {
  const TestSet set = read_bop_set(kModels / "sample_set");
  ASSERT_EQ(set.objects.size(), 1u);
  ASSERT_EQ(set.images.size(), 6u);
  for (const auto& image : set.images) {
    const DepthImage depth = read_depth_png(image.depth, image.depth_scale);
    EXPECT_EQ(depth.width, kSampleWidth);
    EXPECT_EQ(depth.height, kSampleHeight);
    EXPECT_LT(std::filesystem::file_size(image.depth), 400'000u);
    ASSERT_EQ(image.truth.size(), 1u);
    EXPECT_GT(agreement(depth, image.truth[0].camera_T_model), 0.6) << image.depth;
    RigidTransform wrong = image.truth[0].camera_T_model;
    wrong.translation().z() += 0.01;
    EXPECT_LT(agreement(depth, wrong), 0.3) << image.depth;
  }
}

// The whole chain again, noise included. Embree's last bit may differ between processors, which can move a
// rounded millimetre here and there.
TEST(SampleSet, ImagesAreWhatTheGeneratorMakes) {
  const Mesh mesh = phantom_mesh();
  for (const int index : {1, 2}) {
    const DepthImage made = sample_scene(mesh, index).depth;
    const DepthImage shipped = read_depth_png(
        kModels / "sample_set/test/000001/depth" / ("00000" + std::to_string(index) + ".png"), 0.001);
    ASSERT_EQ(made.depth.size(), shipped.depth.size());
    int different = 0;
    for (size_t i = 0; i < made.depth.size(); ++i)
      different += std::abs(made.depth[i] - shipped.depth[i]) > 1e-4f;
    EXPECT_LT(different, static_cast<int>(made.depth.size() / 1000));
  }
}

TEST(SampleScene, IsReadableAndNotInTheSet) {
  const CameraFile camera = read_camera((kModels / "phantom/scene/camera.json").string());
  EXPECT_EQ(camera.camera.fx, kSampleCamera.fx);
  EXPECT_EQ(camera.camera.cy, kSampleCamera.cy);
  EXPECT_EQ(camera.depth_scale, 0.001);
  const DepthImage depth = read_depth_png(kModels / "phantom/scene/depth.png", camera.depth_scale);
  const SampleScene scene = sample_scene(phantom_mesh(), kSampleScenes - 1);
  EXPECT_GT(agreement(depth, scene.camera_T_model), 0.6);
  EXPECT_GT(scene.pixels_visible, 1500);
  EXPECT_LT(scene.pixels_visible, scene.pixels_alone) << "partly covered";
}

}  // namespace
}  // namespace edgepose::phantom
