#include "matcher/pose_comparison.h"

#include <gtest/gtest.h>

#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

/// A closed prism about the z axis, radius 30 mm, height 80 mm.
Mesh prism(uint32_t sides) {
  Mesh mesh;
  for (const float z : {-0.04f, 0.04f})
    for (uint32_t i = 0; i < sides; ++i) {
      const float a = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
      mesh.vertices.emplace_back(0.03f * std::cos(a), 0.03f * std::sin(a), z);
    }
  mesh.vertices.emplace_back(0.f, 0.f, -0.04f);
  mesh.vertices.emplace_back(0.f, 0.f, 0.04f);
  for (uint32_t i = 0; i < sides; ++i) {
    const uint32_t next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, next + sides});
    mesh.triangles.push_back({i, next + sides, i + sides});
    mesh.triangles.push_back({2 * sides, next, i});
    mesh.triangles.push_back({2 * sides + 1, i + sides, next + sides});
  }
  return mesh;
}

PoseF turned(const Eigen::Vector3f& axis, float angle) {
  return {Eigen::AngleAxisf(angle, axis.normalized()).toRotationMatrix(), {0, 0, 0.5f}};
}

TEST(PoseComparison, AnAsymmetricModelIsAlikeOnlyNearby) {
  const PoseComparison comparison(fixtures::bracket_model());
  const PoseF pose = turned({1, 2, 3}, 0.5f);
  PoseF moved = pose;
  EXPECT_TRUE(comparison.alike(pose, moved, 0.02f, 0.05f));
  moved.translation.x() += 0.01f;
  EXPECT_FALSE(comparison.alike(pose, moved, 0.02f, 0.05f));
  EXPECT_FALSE(comparison.alike(pose, turned({1, 2, 3}, 0.7f), 0.02f, 0.05f));
}

TEST(PoseComparison, ACylinderIsAlikeTurnedAboutItsAxisAndTurnedOver) {
  const Model cylinder = train_model(prism(64), "cylinder", fixtures::quick_training());
  ASSERT_FALSE(cylinder.symmetries().continuous.empty());
  const PoseComparison comparison(cylinder);
  const PoseF pose = turned({1, 0, 0}, 0.8f);
  const auto after = [&](const Eigen::Matrix3f& turn) {
    return PoseF{pose.rotation * turn, pose.translation};
  };
  const Eigen::Matrix3f about = Eigen::AngleAxisf(1.234f, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3f over =
      Eigen::AngleAxisf(std::numbers::pi_v<float>, Eigen::Vector3f::UnitX()).toRotationMatrix();
  const Eigen::Matrix3f tilted = Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitX()).toRotationMatrix();
  EXPECT_TRUE(comparison.alike(pose, after(about), 0.02f, 0.1f));
  EXPECT_TRUE(comparison.alike(pose, after(over * about), 0.02f, 0.1f));
  EXPECT_FALSE(comparison.alike(pose, after(tilted), 0.02f, 0.1f));
}

}  // namespace
}  // namespace edgepose
