#include "simulator/starts.h"
#include "simulator/visibility.h"

#include <gtest/gtest.h>

#include "arm/kinematics.h"
#include "arm/rigid_motion.h"
#include "common/error.h"
#include "tests/simulator/cell.h"

namespace edgepose {
namespace {

TEST(Starts, AreWithinTheirBoundsAndClearOfTheBone) {
  const WorkCell cell = phantom_cell();
  for (const DrillTarget& target : cell.plan.targets) {
    const RigidTransform goal = cell.base_T_model * model_T_tool_at(target, 0.04);
    double farthest = 0, most_turned = 0;
    for (uint64_t seed = 1; seed <= 200; ++seed) {
      const JointVector joints = draw_start(cell, target, seed);
      const RigidTransform off = goal.inverse() * base_T_tool(cell, joints);
      farthest = std::max(farthest, off.translation().norm());
      most_turned = std::max(most_turned, rotation_angle(off));
      EXPECT_GE(clearance(cell, base_T_tool(cell, joints)), 0.02 - 1e-9) << seed;
    }
    EXPECT_LE(farthest, 0.1 + 1e-9);
    EXPECT_GT(farthest, 0.08) << "draws reach nearly as far as they may";
    EXPECT_LE(most_turned, 0.34906585 + 1e-9);
    EXPECT_GT(most_turned, 0.3);
  }
}

TEST(Starts, DependOnTheSeedOnly) {
  const WorkCell cell = phantom_cell();
  const DrillTarget& target = cell.find_target(cell.target);
  EXPECT_EQ(draw_start(cell, target, 7), draw_start(phantom_cell(), target, 7));
  EXPECT_GT((draw_start(cell, target, 7) - draw_start(cell, target, 8)).norm(), 0.01);
}

TEST(Starts, StandoffIsFortyMillimetresBeforeTheEntry) {
  const WorkCell cell = phantom_cell();
  const DrillTarget& target = cell.plan.targets[1];
  const PositioningError error = positioning_error(cell, standoff_start(cell, target), target);
  EXPECT_NEAR(error.along, -0.04, 1e-9);
  EXPECT_LT(error.across, 1e-9);
  EXPECT_LT(error.angle, 1e-9);
}

TEST(Starts, RefuseWhatCannotBe) {
  const WorkCell cell = phantom_cell();
  StartOptions options;
  options.max_distance = 5;
  EXPECT_THROW(draw_start(cell, cell.plan.targets[0], 1, options), InputError);
  DrillTarget far = cell.plan.targets[0];
  far.entry += Eigen::Vector3d(0, 3, 0);
  EXPECT_THROW(draw_start(cell, far, 1), InputError);
  EXPECT_THROW(standoff_start(cell, far), InputError);
}

TEST(JointsFor, FindsThePostureAgain) {
  const WorkCell cell = phantom_cell();
  JointVector joints = cell.nominal;
  joints += 0.1 * (JointVector() << 1, -1, 1, -1, 1, -1).finished();
  const auto found = joints_for(cell.arm, base_T_flange(cell.arm, joints), cell.nominal);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - joints).norm(), 1e-8);
}

/// Of the first 200 seeds, six would begin with the drill between camera and bone.
TEST(Starts, TheCameraSeesTheBoneFromThem) {
  const WorkCell c = phantom_cell();
  const DrillTarget& target = c.find_target(c.target);
  StartOptions any;
  any.min_visible = 0;
  int hidden = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    EXPECT_GE(visible_share(c, draw_start(c, target, seed)), 0.5) << seed;
    if (visible_share(c, draw_start(c, target, seed, any)) < 0.5)
      ++hidden;
    else
      EXPECT_EQ(draw_start(c, target, seed), draw_start(c, target, seed, any)) << seed;
  }
  EXPECT_EQ(hidden, 6);
}

}  // namespace
}  // namespace edgepose
