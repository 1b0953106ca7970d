#include <gtest/gtest.h>

#include "matcher/pose_comparison.h"
#include "tests/matcher/solids.h"

namespace edgepose {
namespace {

PoseF pose(const RigidTransform& t) { return {t.linear().cast<float>(), t.translation().cast<float>()}; }

RigidTransform random_pose(fixtures::Random& random) {
  RigidTransform t = RigidTransform::Identity();
  t.linear() = random.rotation();
  t.translation() = random.vector(0.5);
  return t;
}

/// A cone that leans: the box around it is not about its axis.
TEST(PoseComparison, ATurnOfALeaningConeChangesNothing) {
  fixtures::Random random(1);
  RigidTransform lean = RigidTransform::Identity();
  lean.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 0.3, 0).normalized()).toRotationMatrix();
  const Mesh cone = fixtures::moved(fixtures::lathe({{0, -0.03}, {0.04, -0.03}, {0, 0.05}}), lean);
  const Model model = train_model(cone, "cone", fixtures::quick_training());
  const Symmetries symmetries = model.symmetries();
  ASSERT_EQ(symmetries.continuous.size(), 1u);
  const SymmetryAxis axis = symmetries.continuous[0];
  const PoseComparison comparison(model);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform a = random_pose(random);
    RigidTransform turn = RigidTransform::Identity();
    turn.linear() = Eigen::AngleAxisd(random.uniform(0, 6), axis.direction).toRotationMatrix();
    turn.translation() = axis.point - turn.linear() * axis.point;
    EXPECT_TRUE(comparison.alike(pose(a), pose(a * turn), 0.01f, 0.02f));
    EXPECT_FALSE(comparison.alike(pose(a), pose(random_pose(random)), 0.01f, 0.02f));
  }
}

TEST(PoseComparison, EveryTurnOfASphereIsAlike) {
  fixtures::Random random(2);
  const Model model = train_model(fixtures::sphere(0.04), "ball", fixtures::quick_training());
  ASSERT_TRUE(model.symmetries().is_sphere());
  const PoseComparison comparison(model);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform a = random_pose(random);
    RigidTransform b = random_pose(random);
    b.translation() = a.translation();
    EXPECT_TRUE(comparison.alike(pose(a), pose(b), 0.01f, 0.02f));
  }
}

}  // namespace
}  // namespace edgepose
