#include "render/depth_renderer.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/render/shapes.h"

namespace edgepose {
namespace {

const Camera kRenderCamera{500, 480, 159.5, 119.25};
constexpr int kRenderWidth = 320, kRenderHeight = 240;

TEST(DepthRenderer, PlaneFacingTheCameraHasConstantDepth) {
  DepthRenderer renderer;
  renderer.add(shapes::rectangle(10, 10), shapes::at(0, 0, 0.8));
  const RenderedView view = renderer.render(kRenderCamera, kRenderWidth, kRenderHeight);
  for (const float depth : view.depth.depth) ASSERT_NEAR(depth, 0.8f, 1e-6);
}

TEST(DepthRenderer, TiltedPlaneMatchesTheRayEquation) {
  RigidTransform pose = shapes::at(0.02, -0.03, 1.1);
  pose.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 0.3).normalized()));
  DepthRenderer renderer;
  renderer.add(shapes::rectangle(20, 20), pose);
  const RenderedView view = renderer.render(kRenderCamera, kRenderWidth, kRenderHeight);
  const Eigen::Vector3d normal = pose.linear().col(2), point = pose.translation();
  for (int v = 0; v < kRenderHeight; ++v) {
    for (int u = 0; u < kRenderWidth; ++u) {
      const Eigen::Vector3d ray((u - kRenderCamera.cx) / kRenderCamera.fx,
                                (v - kRenderCamera.cy) / kRenderCamera.fy, 1);
      ASSERT_NEAR(view.depth.at(u, v), normal.dot(point) / normal.dot(ray), 5e-6) << u << " " << v;
    }
  }
}

TEST(DepthRenderer, MovingTheCameraIsMovingTheMeshesTheOtherWay) {
  RigidTransform scene_T_camera = shapes::at(0.1, -0.05, -0.3);
  scene_T_camera.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 0.3).normalized()));
  const RigidTransform scene_T_model = shapes::at(0.05, 0.02, 0.7);
  DepthRenderer still, moved;
  still.add(shapes::sphere(0.1f, 100), scene_T_model);
  moved.add(shapes::sphere(0.1f, 100), scene_T_camera.inverse() * scene_T_model);
  const RenderedView a = still.render(kRenderCamera, kRenderWidth, kRenderHeight, 0, scene_T_camera);
  const RenderedView b = moved.render(kRenderCamera, kRenderWidth, kRenderHeight);
  int seen = 0, outline = 0;
  for (size_t i = 0; i < a.object.size(); ++i) {
    if (a.object[i] != b.object[i]) ++outline;
    if (a.object[i] < 0 || b.object[i] < 0) continue;
    ++seen;
    ASSERT_NEAR(a.depth.depth[i], b.depth.depth[i], 1e-5);
  }
  EXPECT_GT(seen, 1000);
  EXPECT_LT(outline, 5);
}

TEST(DepthRenderer, SphereMatchesTheClosedForm) {
  const double radius = 0.1;
  const Eigen::Vector3d centre(0.05, 0.02, 0.7);
  DepthRenderer renderer;
  renderer.add(shapes::sphere(static_cast<float>(radius), 300), shapes::at(0.05, 0.02, 0.7));
  const RenderedView view = renderer.render(kRenderCamera, kRenderWidth, kRenderHeight);
  int inside = 0;
  for (int v = 0; v < kRenderHeight; ++v) {
    for (int u = 0; u < kRenderWidth; ++u) {
      const Eigen::Vector3d ray((u - kRenderCamera.cx) / kRenderCamera.fx,
                                (v - kRenderCamera.cy) / kRenderCamera.fy, 1);
      const double b = ray.dot(centre), a = ray.squaredNorm();
      const double root = b * b - a * (centre.squaredNorm() - radius * radius);
      if (root < -1e-5) {
        ASSERT_EQ(view.depth.at(u, v), 0) << u << " " << v;
        ASSERT_EQ(view.object[static_cast<size_t>(v * kRenderWidth + u)], -1);
      } else if (root > 1e-4) {
        ASSERT_NEAR(view.depth.at(u, v), (b - std::sqrt(root)) / a, 2e-4) << u << " " << v;
        ASSERT_EQ(view.object[static_cast<size_t>(v * kRenderWidth + u)], 0);
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 10000);
}

// A rectangle whose border runs between two pixel centres covers exactly the pixels whose centre is inside.
TEST(DepthRenderer, PixelCentresAreIntegerCoordinates) {
  const Camera camera{100, 100, 10, 20};
  Mesh mesh;  // at depth 1: u in (29.5, 40.5), v in (24.5, 29.5)
  const auto x = [](double u) { return static_cast<float>((u - 10) / 100); };
  const auto y = [](double v) { return static_cast<float>((v - 20) / 100); };
  mesh.vertices = {
      {x(29.5), y(24.5), 1}, {x(40.5), y(24.5), 1}, {x(40.5), y(29.5), 1}, {x(29.5), y(29.5), 1}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  DepthRenderer renderer;
  renderer.add(mesh);
  const RenderedView view = renderer.render(camera, 60, 50);
  for (int v = 0; v < 50; ++v) {
    for (int u = 0; u < 60; ++u) {
      const bool inside = u >= 30 && u <= 40 && v >= 25 && v <= 29;
      EXPECT_EQ(view.depth.at(u, v) > 0, inside) << u << " " << v;
    }
  }
}

TEST(DepthRenderer, XPointsRightAndYPointsDown) {
  DepthRenderer renderer;
  const size_t right = renderer.add(shapes::sphere(0.02f, 20), shapes::at(0.1, 0, 0.5));
  const size_t below = renderer.add(shapes::sphere(0.02f, 20), shapes::at(0, 0.1, 0.5));
  const Camera camera{300, 300, 160, 120};
  const RenderedView view = renderer.render(camera, kRenderWidth, kRenderHeight);
  const auto at = [&](int u, int v) { return view.object[static_cast<size_t>(v * kRenderWidth + u)]; };
  EXPECT_EQ(at(220, 120), static_cast<int>(right));
  EXPECT_EQ(at(160, 180), static_cast<int>(below));
  EXPECT_EQ(at(160, 120), -1);
}

TEST(DepthRenderer, NearerObjectHidesTheOtherAndCanBeMovedAway) {
  DepthRenderer renderer;
  const size_t wall = renderer.add(shapes::rectangle(1, 1), shapes::at(0, 0, 1));
  const size_t card = renderer.add(shapes::rectangle(0.05f, 0.05f), shapes::at(0, 0, 0.5));
  RenderedView view = renderer.render(kRenderCamera, kRenderWidth, kRenderHeight);
  const size_t middle = 119 * kRenderWidth + 160;
  EXPECT_EQ(view.object[middle], static_cast<int>(card));
  EXPECT_NEAR(view.depth.depth[middle], 0.5f, 1e-6);
  renderer.set_pose(card, shapes::at(5, 0, 0.5));
  view = renderer.render(kRenderCamera, kRenderWidth, kRenderHeight);
  EXPECT_EQ(view.object[middle], static_cast<int>(wall));
  EXPECT_NEAR(view.depth.depth[middle], 1.0f, 1e-6);
}

TEST(DepthRenderer, NothingBehindTheCameraIsSeen) {
  DepthRenderer renderer;
  renderer.add(shapes::rectangle(1, 1), shapes::at(0, 0, -1));
  for (const float depth : renderer.render(kRenderCamera, kRenderWidth, kRenderHeight).depth.depth)
    ASSERT_EQ(depth, 0);
}

TEST(DepthRenderer, SameBitsAtAnyThreadCountAndInEveryRun) {
  const auto render = [](int threads) {
    DepthRenderer renderer;
    renderer.add(shapes::sphere(0.1f, 100), shapes::at(0.01, 0.02, 0.6));
    renderer.add(shapes::rectangle(1, 1), shapes::at(0, 0, 0.65));
    return renderer.render(kRenderCamera, kRenderWidth, kRenderHeight, threads);
  };
  const RenderedView one = render(1);
  for (const int threads : {1, 2, 7}) {
    const RenderedView other = render(threads);
    EXPECT_EQ(one.depth.depth, other.depth.depth);
    EXPECT_EQ(one.object, other.object);
  }
}

TEST(DepthRenderer, EmptySceneGivesAnEmptyImage) {
  for (const float depth : DepthRenderer().render(kRenderCamera, 8, 8).depth.depth) EXPECT_EQ(depth, 0);
}

TEST(DepthRenderer, RefusesUnsoundInput) {
  DepthRenderer renderer;
  Mesh mesh = shapes::rectangle(1, 1);
  mesh.triangles.push_back({0, 1, 4});
  EXPECT_THROW(renderer.add(mesh), std::invalid_argument);
  mesh = shapes::rectangle(1, 1);
  mesh.vertices[2].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(renderer.add(mesh), std::invalid_argument);
  mesh = shapes::rectangle(1, 1);
  mesh.triangles.clear();
  EXPECT_THROW(renderer.add(mesh), std::invalid_argument);
  RigidTransform pose = RigidTransform::Identity();
  pose.translation().x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(renderer.add(shapes::rectangle(1, 1), pose), std::invalid_argument);
  EXPECT_THROW(renderer.set_pose(0, RigidTransform::Identity()), std::out_of_range);
  EXPECT_THROW(renderer.render({0, 1, 0, 0}, 8, 8), std::invalid_argument);
  EXPECT_THROW(renderer.render({1, std::nan(""), 0, 0}, 8, 8), std::invalid_argument);
  EXPECT_THROW(renderer.render(kRenderCamera, 0, 8), std::invalid_argument);
  EXPECT_THROW(renderer.render(kRenderCamera, 8, 100000), std::invalid_argument);
}

}  // namespace
}  // namespace edgepose
