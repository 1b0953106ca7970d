#include "servoing/chain.h"

#include <gtest/gtest.h>

#include "tests/servoing/rig.h"

namespace edgepose {
namespace {

TEST(Chain, PaperEquationsBringTheToolToTheHole) {
  Draws draws(1);
  for (int i = 0; i < 100; ++i) {
    // A world in which everything is known: the chain must lead the tool exactly to the hole.
    const ToldCalibration rig{draws.pose(1, 0.2), draws.pose(1, 0.2)};
    const RigidTransform base_T_flange = draws.pose(3, 0.6), base_T_model = draws.pose(3, 0.6);
    const RigidTransform model_T_hole = draws.pose(3, 0.05);
    const RigidTransform camera_T_model = (base_T_flange * rig.flange_T_camera).inverse() * base_T_model;
    const RigidTransform goal = tool_T_tool_goal(camera_T_tool(rig), camera_T_model, model_T_hole);
    const RigidTransform reached = base_T_tool_goal(base_T_flange, rig.flange_T_tool, goal);
    EXPECT_LT(difference(reached, base_T_model * model_T_hole), 1e-12);
  }
}

TEST(Chain, ExactGoalIsThatOfTheCalibrationsWhereTheyAreTrue) {
  Draws draws(2);
  const ToldCalibration rig = true_rig();
  const RigidTransform hole = draws.pose(0.5, 0.05);
  const RigidTransform goal = camera_T_model_goal(camera_T_tool(rig), hole);
  EXPECT_LT(difference(camera_T_tool(goal, hole), camera_T_tool(rig)), 1e-12);
}

TEST(Chain, GoalHasItsTipBeforeTheEntryAndItsAxisAlongTheHole) {
  Draws draws(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d entry = draws.vector(0.1), axis = draws.gauss(1).normalized();
    const RigidTransform now = draws.pose(3, 0.2);
    const RigidTransform goal = model_T_tool_goal(entry, axis, 0.04, now);
    EXPECT_LT((goal * Eigen::Vector3d(0, 0, 0.04) - entry).norm(), 1e-12) << "40 mm forward is the entry";
    EXPECT_LT((goal.linear().col(2) - axis).norm(), 1e-9);
  }
}

TEST(Chain, FreeTurnAboutTheAxisIsTheNearest) {
  Draws draws(4);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d axis = draws.gauss(1).normalized();
    const RigidTransform now = draws.pose(3, 0.2);
    const RigidTransform goal = model_T_tool_goal({0, 0, 0}, axis, 0, now);
    const double chosen = rotation_angle(now.inverse() * goal);
    for (double turn = 0.05; turn < 6.25; turn += 0.05) {
      const RigidTransform other = goal * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
      EXPECT_GE(rotation_angle(now.inverse() * other), chosen - 1e-9);
    }
  }
}

TEST(Chain, ErrorsOfCalibrationStayInAGoalThatIsMadeOfThem) {
  // The tip error at convergence is Y^^-1 X^ X^-1 Y, whatever the loop does.
  const ToldCalibration truth = true_rig();
  ToldCalibration told = truth;
  told.flange_T_tool.translation().x() += 0.01;
  const RigidTransform error = camera_T_tool(told).inverse() * camera_T_tool(truth);
  EXPECT_NEAR(error.translation().norm(), 0.01, 1e-9);
}

}  // namespace
}  // namespace edgepose
