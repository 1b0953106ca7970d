#include "matcher/posed_surface.h"

#include <gtest/gtest.h>

#include "matcher/lanes.h"
#include "tests/matcher/search_fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket_model;

TEST(PosedSurface, IsWhatAPlainLoopGives) {
  const fixtures::Sampled seen(3);
  const Scene::Data& scene = seen.scene->data();
  const Model::View& model = bracket_model().view();
  const PixelProjection projection(scene);
  fixtures::Random random(8);
  PosedSurface surface;
  size_t inside = 0, outside = 0;
  for (int i = 0; i < 20; ++i) {
    const PoseF pose = seen.perturbed(random, 0.5, i % 2 ? 0.02 : 0.6);  // in the image, and half out of it
    const size_t view = view_of_pose(model, pose, box_centre(*model.header));
    const size_t limit = i % 3 ? 200 : 1500;
    surface.take(model, view, limit);
    surface.place(pose, projection);
    std::vector<uint32_t> visible;
    for_visible_points(model, view, limit, [&](size_t k) { visible.push_back(static_cast<uint32_t>(k)); });
    ASSERT_EQ(surface.indices, visible);
    ASSERT_EQ(surface.padded(), whole_lanes(visible.size()));
    for (size_t k = 0; k < visible.size(); ++k) {
      const OrientedPoint& point = model.dense_points[visible[k]];
      const Eigen::Vector3f p = pose * point.position, n = pose.rotation * point.normal;
      EXPECT_LT((Eigen::Vector3f(surface.x[k], surface.y[k], surface.z[k]) - p).norm(), 1e-6);
      EXPECT_LT((Eigen::Vector3f(surface.nx[k], surface.ny[k], surface.nz[k]) - n).norm(), 1e-5);
      const auto pixel = static_cast<int64_t>(projection.pixel(p));
      const Eigen::Vector2f at = projection.project(p);
      const auto near_border = [](float c) { return std::abs(c + 0.5f - std::round(c + 0.5f)) < 1e-3f; };
      if (p.z() > 0.01f && (near_border(at.x()) || near_border(at.y()))) continue;  // rounding may decide
      ASSERT_EQ(surface.pixel[k], pixel);
      if (pixel < 0) {
        ++outside;
        continue;
      }
      ++inside;
      const Eigen::Vector3f ray =
          scene.ray(static_cast<int>(pixel % scene.width), static_cast<int>(pixel / scene.width));
      EXPECT_NEAR(surface.ray_x[k], ray.x(), 1e-6);
      EXPECT_NEAR(surface.ray_y[k], ray.y(), 1e-6);
    }
    for (size_t k = visible.size(); k < surface.padded(); ++k) EXPECT_EQ(surface.pixel[k], -1);
  }
  EXPECT_GT(inside, 1000u);
  EXPECT_GT(outside, 100u);
}

}  // namespace
}  // namespace edgepose
