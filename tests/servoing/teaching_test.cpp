#include "servoing/teaching.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "tests/servoing/rig.h"

namespace edgepose {
namespace {

/// `count` references of 30 noisy poses each, the tool truly at each.
std::vector<TaughtReference> references(int count, double translation_noise, double rotation_noise) {
  Draws draws(5);
  const RigidTransform truth = camera_T_tool(true_rig());
  std::vector<TaughtReference> result;
  for (int i = 0; i < count; ++i) {
    TaughtReference reference{"hole " + std::to_string(i + 1), draws.pose(0.5, 0.05), {}};
    for (int k = 0; k < 30; ++k)
      reference.camera_T_model.push_back(
          camera_T_model_goal(truth, reference.model_T_tool) *
          rigid_transform(rotation_matrix(draws.gauss(rotation_noise)), draws.gauss(translation_noise)));
    result.push_back(reference);
  }
  return result;
}

std::string refusal(const std::vector<TaughtReference>& references) {
  try {
    teach(references);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MeanPose, OfPosesAroundOneIsThatOne) {
  Draws draws(1);
  const RigidTransform centre = draws.pose(3, 0.5);
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d turn = draws.vector(0.3), shift = draws.vector(0.01);
    poses.push_back(centre * rigid_transform(rotation_matrix(turn), shift));
    poses.push_back(centre * rigid_transform(rotation_matrix(-turn), -shift));
  }
  EXPECT_LT(difference(mean_pose(poses), centre), 1e-12);
}

TEST(MeanPose, MinimisesTheChordalDistance) {
  Draws draws(2);
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 9; ++i) poses.push_back(draws.pose(0.7, 0.1));
  const RigidTransform mean = mean_pose(poses);
  const auto cost = [&](const Eigen::Matrix3d& rotation) {
    double sum = 0;
    for (const RigidTransform& pose : poses) sum += (pose.linear() - rotation).squaredNorm();
    return sum;
  };
  for (int i = 0; i < 200; ++i)
    EXPECT_GE(cost(mean.linear() * rotation_matrix(draws.within(0.05))), cost(mean.linear()));
}

TEST(Teaching, FindsTheToolInTheCamera) {
  const TaughtTool taught = teach(references(5, 0, 0));
  EXPECT_LT(difference(taught.camera_T_tool, camera_T_tool(true_rig())), 1e-9);
  ASSERT_EQ(taught.residuals.size(), 5u);
  EXPECT_LT(taught.residuals[0].translation, 1e-9);
}

TEST(Teaching, AveragesNoise) {
  const TaughtTool taught = teach(references(5, 0.0003, 0.002));
  const RigidTransform error = taught.camera_T_tool.inverse() * camera_T_tool(true_rig());
  // The lever from the model to the camera, 0.35 m, makes 0.7 mm of 0.002 rad for one pose; there are 150.
  EXPECT_LT(error.translation().norm(), 0.0003);
  EXPECT_GT(taught.residuals[2].noise.translation, 0.0003);
  EXPECT_LT(taught.residuals[2].noise.translation, 0.0008);
  EXPECT_EQ(taught.residuals[2].poses, 30);
}

TEST(Teaching, SaysWhatIsMissingOrWrong) {
  EXPECT_NE(refusal(references(4, 0, 0)).find("at least 5 references, found 4"), std::string::npos);
  auto few = references(5, 0, 0);
  few[1].camera_T_model.resize(29);
  EXPECT_NE(refusal(few).find("reference hole 2: expected at least 30 poses, found 29"), std::string::npos);
  EXPECT_NE(refusal(references(5, 0.004, 0)).find("scatter"), std::string::npos);
  auto mixed_up = references(5, 0, 0);
  std::swap(mixed_up[0].model_T_tool, mixed_up[4].model_T_tool);
  EXPECT_NE(refusal(mixed_up).find("was the right place touched"), std::string::npos);
  auto scaled = references(5, 0, 0);
  scaled[3].camera_T_model[7].linear() *= 2;
  EXPECT_NE(refusal(scaled).find("hole 4: expected rigid poses"), std::string::npos);
}

}  // namespace
}  // namespace edgepose
