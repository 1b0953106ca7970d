#include <gtest/gtest.h>

#include "matcher/large_planes.h"
#include "matcher/scene_sampling.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

constexpr float kGridStep = 0.005f, kModelDiameter = 0.1f;

Scene bracket_scene() {
  fixtures::Random random(5);
  const RigidTransform pose = fixtures::pose_on_table(fixtures::bracket(), fixtures::table(), random);
  return prepare_scene(fixtures::render(fixtures::table(), fixtures::bracket(), pose), fixtures::kCamera);
}

SamplingOptions thinned() {
  SamplingOptions options;
  options.enough_points = 0;
  return options;
}

SamplingOptions unthinned() {
  SamplingOptions options;
  options.enough_points = 1000000;
  return options;
}

TEST(Sampling, ThinsTheEvenSurfaceAndKeepsEdges) {
  const Scene scene = bracket_scene();
  const auto all = sample_scene(scene.data(), kGridStep, kModelDiameter, unthinned(), 1);
  const auto points = sample_scene(scene.data(), kGridStep, kModelDiameter, thinned(), 1);
  EXPECT_LT(points.size(), all.size() / 2);
  const auto edges = [](const auto& of) {
    return std::count_if(of.begin(), of.end(), [](const SampledPoint& p) { return p.edge; });
  };
  EXPECT_GT(edges(points), 50);
  EXPECT_EQ(edges(points), edges(all));
  SamplingOptions even = thinned();
  even.keep_edges = false;
  EXPECT_GT(sample_scene(scene.data(), kGridStep, kModelDiameter, even, 1).size(), points.size());
}

TEST(Sampling, PointsLieOnTheSurfaceAndAreTheSameForAnyThreads) {
  const Scene scene = bracket_scene();
  const auto points = sample_scene(scene.data(), kGridStep, kModelDiameter, unthinned(), 1);
  // A scene of its own, as a scene keeps its samples.
  const auto again = sample_scene(bracket_scene().data(), kGridStep, kModelDiameter, unthinned(), 3);
  ASSERT_EQ(points.size(), again.size());
  const Scene::Data& data = scene.data();
  size_t off = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& p = points[i].surface.position;
    ASSERT_EQ(p, again[i].surface.position);
    ASSERT_EQ(points[i].surface.normal, again[i].surface.normal);
    ASSERT_EQ(points[i].area, again[i].area);
    ASSERT_EQ(points[i].edge, again[i].edge);
    ASSERT_NEAR(points[i].surface.normal.norm(), 1, 1e-5);
    ASSERT_GT(points[i].area, 0);
    const int u = static_cast<int>(std::lround(p.x() / p.z() * fixtures::kCamera.fx + fixtures::kCamera.cx));
    const int v = static_cast<int>(std::lround(p.y() / p.z() * fixtures::kCamera.fy + fixtures::kCamera.cy));
    ASSERT_TRUE(data.inside(u, v));
    off += std::abs(p.z() - data.depth[data.index(u, v)]) > kGridStep / 2;
  }
  EXPECT_LT(off, points.size() / 20) << "only where a cell spans an edge";
}

TEST(Sampling, LeavesOutWhatIsTooCoarse) {
  const Scene scene = bracket_scene();
  SamplingOptions fine;
  fine.max_pixel_size = 0.001f / kModelDiameter;  // the table begins at some 0.25 m: a pixel spans 1 mm there
  const auto all = sample_scene(scene.data(), kGridStep, kModelDiameter, {}, 1);
  const auto near = sample_scene(scene.data(), kGridStep, kModelDiameter, fine, 1);
  EXPECT_LT(near.size(), all.size());
  for (const SampledPoint& p : near) EXPECT_LE(p.surface.position.z() / fixtures::kCamera.fx, 0.00101);
}

TEST(LargePlanes, TheTableGoesTheBracketStays) {
  const Scene scene = bracket_scene();
  const auto points = sample_scene(scene.data(), kGridStep, kModelDiameter, {}, 1);
  const auto kept = drop_large_planes(points, kModelDiameter, scene.data().noise, 2);
  const fixtures::Plane table = fixtures::table();
  const auto above = [&](const SampledPoint& p) {
    return table.normal.dot(p.surface.position.cast<double>()) - table.offset > 0.004;
  };
  const auto object = std::count_if(points.begin(), points.end(), above);
  const auto object_kept = std::count_if(kept.begin(), kept.end(), above);
  EXPECT_GT(object, 50);
  EXPECT_GT(object_kept, object * 9 / 10);
  EXPECT_LT(kept.size() - static_cast<size_t>(object_kept),
            (points.size() - static_cast<size_t>(object)) / 4);
}

}  // namespace
}  // namespace edgepose
