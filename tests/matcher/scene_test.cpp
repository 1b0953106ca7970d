#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "matcher/scene_data.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

using fixtures::kCamera;
using fixtures::kHeight;
using fixtures::kWidth;

DepthImage even(float depth) {
  return {kWidth, kHeight, std::vector<float>(size_t{kWidth} * kHeight, depth)};
}

TEST(PrepareScene, TiltedPlaneHasItsNormalAndNoEdges) {
  for (double tilt : {0.0, 0.3, 0.7, 1.0}) {
    const Eigen::Vector3d normal(std::sin(tilt) * 0.8, std::sin(tilt) * 0.6, -std::cos(tilt));
    const Scene scene = prepare_scene(fixtures::render({normal, -0.5 * std::cos(tilt)}), kCamera);
    const Scene::Data& data = scene.data();
    for (int v = 5; v < kHeight - 5; ++v)
      for (int u = 5; u < kWidth - 5; ++u) {
        const size_t at = data.index(u, v);
        ASSERT_GT(data.smooth_depth[at], 0) << tilt << ": " << u << " " << v;
        ASSERT_GT(data.normals[at].cast<double>().dot(normal), std::cos(0.5 * std::numbers::pi / 180));
        ASSERT_NEAR(data.smooth_depth[at], data.depth[at], 1e-4f * data.depth[at]);
        ASSERT_EQ(data.edges[at], EdgeKind::kNone) << tilt << ": " << u << " " << v;
      }
  }
}

TEST(PrepareScene, StepHasAnEdgeOnTheNearSideOnly) {
  DepthImage image = even(0.6f);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < 100; ++u) image.at(u, v) = 0.5f;
  const Scene scene = prepare_scene(image, kCamera);
  const Scene::Data& data = scene.data();
  for (int v = 5; v < kHeight - 5; ++v)
    for (int u = 5; u < kWidth - 5; ++u)
      ASSERT_EQ(data.edges[data.index(u, v)], u == 99 ? EdgeKind::kOccluding : EdgeKind::kNone)
          << u << " " << v;
}

TEST(PrepareScene, HoleHasABoundary) {
  DepthImage image = even(0.5f);
  for (int v = 60; v < 100; ++v)
    for (int u = 80; u < 120; ++u) image.at(u, v) = 0;
  const Scene scene = prepare_scene(image, kCamera);
  const Scene::Data& data = scene.data();
  EXPECT_EQ(data.edges[data.index(79, 80)], EdgeKind::kBoundary);
  EXPECT_EQ(data.edges[data.index(120, 80)], EdgeKind::kBoundary);
  EXPECT_EQ(data.edges[data.index(60, 80)], EdgeKind::kNone);
  EXPECT_EQ(data.edges[data.index(100, 80)], EdgeKind::kNone) << "nothing is measured there";
}

TEST(PrepareScene, FoldIsACrease) {
  DepthImage image = even(0);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const double x = fixtures::ray(u, v).x();  // z = 0.5 - |x|: two planes at a right angle
      image.at(u, v) = static_cast<float>(0.5 / (1 + std::abs(x)));
    }
  const Scene scene = prepare_scene(image, kCamera);
  const Scene::Data& data = scene.data();
  for (int v = 10; v < kHeight - 10; ++v) {
    EXPECT_EQ(data.edges[data.index(100, v)], EdgeKind::kCrease);
    EXPECT_EQ(data.edges[data.index(70, v)], EdgeKind::kNone);
    EXPECT_EQ(data.edges[data.index(130, v)], EdgeKind::kNone);
  }
}

TEST(PrepareScene, RefusesBadInput) {
  const DepthImage good = even(0.5f);
  EXPECT_NO_THROW(prepare_scene(good, kCamera));
  EXPECT_THROW(prepare_scene({}, kCamera), std::invalid_argument);
  EXPECT_THROW(prepare_scene(even(0), kCamera), std::invalid_argument);
  EXPECT_THROW(prepare_scene(even(-1), kCamera), std::invalid_argument);
  EXPECT_THROW(prepare_scene(even(std::numeric_limits<float>::quiet_NaN()), kCamera), std::invalid_argument);
  EXPECT_THROW(prepare_scene(even(std::numeric_limits<float>::infinity()), kCamera), std::invalid_argument);
  DepthImage wrong_size = good;
  wrong_size.depth.pop_back();
  EXPECT_THROW(prepare_scene(wrong_size, kCamera), std::invalid_argument);
  DepthImage negative = good;
  negative.width = -kWidth, negative.height = -kHeight;
  EXPECT_THROW(prepare_scene(negative, kCamera), std::invalid_argument);
  for (double bad :
       {0.0, -250.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Camera camera = kCamera;
    camera.fx = bad;
    EXPECT_THROW(prepare_scene(good, camera), std::invalid_argument) << bad;
    camera = kCamera, camera.fy = bad;
    EXPECT_THROW(prepare_scene(good, camera), std::invalid_argument) << bad;
  }
  Camera camera = kCamera;
  camera.cx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(prepare_scene(good, camera), std::invalid_argument);
}

TEST(PrepareScene, IgnoresSingleBadValues) {
  DepthImage image = even(0.5f);
  image.at(50, 50) = std::numeric_limits<float>::quiet_NaN();
  image.at(90, 50) = -3;
  image.at(50, 90) = 1e30f;
  const Scene scene = prepare_scene(image, kCamera);
  const Scene::Data& data = scene.data();
  for (const auto& n : data.normals) ASSERT_TRUE(n.allFinite());
  EXPECT_EQ(data.depth[data.index(50, 50)], 0);
  EXPECT_EQ(data.depth[data.index(90, 50)], 0);
  EXPECT_EQ(data.depth[data.index(50, 90)], 0);
}

}  // namespace
}  // namespace edgepose
