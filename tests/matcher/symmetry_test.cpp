#include "matcher/symmetry.h"

#include <gtest/gtest.h>

#include "matcher/surface_sampling.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

Symmetries symmetries_of(const std::vector<OrientedPoint>& surface) {
  const float d = largest_distance(surface);
  std::vector<OrientedPoint> points;
  for (uint32_t i : thin_out(surface, {0.144f * d, 0.072f * d, 0.036f * d, 0.018f * d}))
    points.push_back(surface[i]);
  return find_symmetries(points, surface, d);
}

TEST(FindSymmetries, BracketHasNone) {
  const auto found = symmetries_of(sample_surface(fixtures::bracket(), 30000, 1));
  EXPECT_TRUE(found.empty()) << found.discrete.size() << " " << found.continuous.size();
}

TEST(FindSymmetries, CylinderTurnsAboutItsAxis) {
  constexpr double kRadius = 0.03, kLength = 0.1;
  const Eigen::Vector3d centre(0.1, -0.2, 0.3);
  fixtures::Random random(2);
  std::vector<OrientedPoint> surface;
  for (int i = 0; i < 30000; ++i) {
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0);
    Eigen::Vector3d at, normal;
    if (random.uniform(0, kLength + kRadius) < kLength) {  // the side's area to the caps' is height to radius
      normal = out, at = kRadius * out + Eigen::Vector3d(0, 0, random.uniform(-kLength / 2, kLength / 2));
    } else {
      const double side = random.below(2) == 0 ? 1 : -1;
      normal = {0, 0, side};
      at = kRadius * std::sqrt(random.uniform(0, 1)) * out + kLength / 2 * normal;
    }
    surface.push_back({(centre + at).cast<float>(), normal.cast<float>()});
  }
  const auto found = symmetries_of(surface);
  ASSERT_EQ(found.continuous.size(), 1u);
  EXPECT_GT(std::abs(found.continuous[0].direction.z()), 0.9995);
  EXPECT_LT((found.continuous[0].point - centre).head<2>().norm(), 0.001);
  ASSERT_EQ(found.discrete.size(), 1u) << "upside down";
  EXPECT_LT(found.discrete[0].linear()(2, 2), -0.999);
}

TEST(FindSymmetries, BoxHasThreeHalfTurns) {
  const Eigen::Vector3f half(0.01f, 0.02f, 0.03f);
  Mesh box;
  for (int i = 0; i < 8; ++i)
    box.vertices.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                              i & 4 ? half.z() : -half.z());
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto found = symmetries_of(sample_surface(box, 30000, 1));
  EXPECT_TRUE(found.continuous.empty());
  ASSERT_EQ(found.discrete.size(), 3u);
  Eigen::Vector3d axes = Eigen::Vector3d::Zero();
  for (const auto& motion : found.discrete) {
    const Eigen::AngleAxisd turn(motion.linear());
    EXPECT_NEAR(turn.angle(), std::numbers::pi, 0.03);
    axes += turn.axis().cwiseAbs();
  }
  EXPECT_LT((axes - Eigen::Vector3d::Ones()).norm(), 0.1) << "one about each axis";
}

}  // namespace
}  // namespace edgepose
