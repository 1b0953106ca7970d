#include <gtest/gtest.h>

#include "matcher/large_planes.h"
#include "matcher/scene_sampling.h"

namespace edgepose {
namespace {

TEST(DropLargePlanes, TableGoesBlockStays) {
  constexpr float kDiameter = 0.1f, kStep = 0.005f, kArea = kStep * kStep, kTableDepth = 0.8f, kTop = 0.77f;
  std::vector<SampledPoint> points;
  const auto add = [&](float x, float y, float z, const Eigen::Vector3f& normal) {
    points.push_back({{{x, y, z}, normal}, kArea, false});
  };
  for (int i = -50; i <= 50; ++i)
    for (int k = -50; k <= 50; ++k) {
      const float x = static_cast<float>(i) * kStep, y = static_cast<float>(k) * kStep;
      const bool on_block = std::abs(i) <= 4 && std::abs(k) <= 4;
      add(x, y, on_block ? kTop : kTableDepth, {0, 0, -1});
    }
  for (int i = -4; i <= 4; ++i)
    for (float z = kTop + kStep; z < kTableDepth; z += kStep) {
      add(0.0225f, static_cast<float>(i) * kStep, z, {1, 0, 0});
      add(static_cast<float>(i) * kStep, 0.0225f, z, {0, 1, 0});
    }
  const auto on_table = [&](const SampledPoint& p) { return p.surface.position.z() == kTableDepth; };
  size_t block = 0;
  for (const auto& p : points) block += !on_table(p);

  const NoiseCurve noise{};
  const auto kept = drop_large_planes(points, kDiameter, noise, 1);
  size_t kept_block = 0;
  for (const auto& p : kept) {
    const Eigen::Vector3f& at = p.surface.position;
    kept_block += !on_table(p);
    if (on_table(p)) {
      EXPECT_GT(std::max(std::abs(at.x()), std::abs(at.y())), 0.2f)
          << "table at " << at.transpose() << " kept";
    }
  }
  EXPECT_EQ(kept_block, block);
  // A large object keeps all of it: the table is no larger than its own faces can be.
  EXPECT_EQ(drop_large_planes(points, 1, noise, 1).size(), points.size());
  EXPECT_TRUE(drop_large_planes({}, kDiameter, noise, 2).empty());
}

}  // namespace
}  // namespace edgepose
