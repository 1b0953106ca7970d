#include "servoing/servo_law.h"

#include <gtest/gtest.h>

#include "tests/servoing/rig.h"

namespace edgepose {
namespace {

TEST(ServoLaw, LeadsStraightToTheGoal) {
  Draws draws(1);
  for (int trial = 0; trial < 50; ++trial) {
    RigidTransform goal_T_body = draws.pose(2.5, 0.3);
    const Eigen::Vector3d start = goal_T_body.translation();
    constexpr double kStep = 0.01;
    GoalError last = goal_error(goal_T_body);
    for (int i = 0; i < 3000; ++i) {
      const Twist twist = servo_command(goal_T_body, {}).body_twist;
      goal_T_body =
          goal_T_body * rigid_transform(rotation_matrix(twist.tail<3>() * kStep), twist.head<3>() * kStep);
      const GoalError error = goal_error(goal_T_body);
      ASSERT_LE(error.rotation, last.rotation + 1e-12);
      last = error;
      // On the line from the start to the goal, to the error of the steps.
      EXPECT_LT(start.normalized().cross(goal_T_body.translation()).norm(),
                1e-9 + 0.05 * start.norm() * kStep);
    }
    EXPECT_LT(last.translation, 1e-6);
    EXPECT_LT(last.rotation, 1e-6);
  }
}

TEST(ServoLaw, RefusesToTurnNearlyHalfATurn) {
  const auto turned = [](double angle) {
    return rigid_transform(rotation_matrix(Eigen::Vector3d(0, angle, 0)), {0.1, 0, 0});
  };
  const ServoCommand refused = servo_command(turned(3.1), {});
  EXPECT_TRUE(refused.near_half_turn);
  EXPECT_TRUE(refused.body_twist.isZero(0));
  EXPECT_TRUE(servo_command(turned(2.97), {}).near_half_turn);
  EXPECT_FALSE(servo_command(turned(2.96), {}).near_half_turn);
  RigidTransform no_number = turned(0);
  no_number.linear()(0, 0) = std::nan("");
  EXPECT_TRUE(servo_command(no_number, {}).body_twist.isZero(0));
}

TEST(ServoLaw, GainIsViSPs) {
  const AdaptiveGain gain{1.5, 0.4, 30};
  EXPECT_DOUBLE_EQ(gain(0), 1.5);
  EXPECT_NEAR(gain(10), 0.4, 1e-12);
  EXPECT_NEAR((gain(1e-6) - gain(0)) / 1e-6, -30, 1e-2);
  EXPECT_NEAR(gain(0.05), 1.1 * std::exp(-30 * 0.05 / 1.1) + 0.4, 1e-12);
  EXPECT_DOUBLE_EQ((AdaptiveGain{0.8, 0.8, 30})(0.3), 0.8);
}

TEST(ServoLaw, GainNamesItsFault) {
  EXPECT_EQ(AdaptiveGain().check(), "");
  EXPECT_EQ((AdaptiveGain{1, 2, 30}).check().substr(0, 17), "gain.at_infinity:");
}

}  // namespace
}  // namespace edgepose
