#include <gtest/gtest.h>

#include "matcher/icp.h"
#include "tests/matcher/search_fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket_model;

class Refinement : public testing::TestWithParam<uint64_t> {};

TEST_P(Refinement, PullsAPerturbedPoseBack) {
  const fixtures::Sampled seen(GetParam());
  const auto d = static_cast<float>(bracket_model().diameter());
  fixtures::Random random(GetParam() + 100);
  IcpOptions options;
  options.max_distance = 0.06f * d;
  options.min_distance = 0.01f * d;
  options.max_points = 1500;
  options.iterations = 15;
  PoseWorkspace work;
  for (int i = 0; i < 5; ++i) {
    const PoseF start = seen.perturbed(random, 0.08, 0.03 * d);
    const IcpResult result = refine_pose(seen.scene->data(), bracket_model().view(), start, options, work);
    EXPECT_LT(seen.distance(result.camera_T_model), 0.01 * d);
    EXPECT_LT(seen.angle(result.camera_T_model), 0.03);
    EXPECT_LT(result.rms, 0.005f * d);
    EXPECT_GT(result.correspondences, 100);
  }
}

TEST_P(Refinement, LeavesAPoseWithoutCorrespondencesAlone) {
  const fixtures::Sampled seen(GetParam());
  PoseF far = seen.truth();
  far.translation.z() += 1;
  PoseWorkspace work;
  const IcpResult result = refine_pose(seen.scene->data(), bracket_model().view(), far, {}, work);
  EXPECT_EQ(result.camera_T_model.translation, far.translation);
  EXPECT_LT(result.correspondences, 6);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Refinement, testing::Values(1, 2, 3, 4));

TEST(Covariance, IsAsLargeAsTheErrorsReallyAre) {
  // Normalised squared errors of 6 degrees of freedom have the median 5.35 if the covariance is right.
  std::vector<double> squares;
  for (uint64_t seed = 1; seed <= 32; ++seed) {
    const fixtures::Sampled seen(seed, 0.0006f);
    const MatchResult result = match(*seen.scene, bracket_model());
    if (result.detections.empty() || !result.detections[0].accepted) continue;
    const Detection& found = result.detections[0];
    const Eigen::Vector3d centre = bracket_model().centre();
    const Eigen::AngleAxisd turn(seen.camera_T_model.linear() * found.camera_T_model.linear().transpose());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(), seen.camera_T_model * centre - found.camera_T_model * centre;
    squares.push_back(error.dot(found.covariance.inverse() * error));
  }
  ASSERT_GT(squares.size(), 20u);
  std::sort(squares.begin(), squares.end());
  const double median = squares[squares.size() / 2];
  EXPECT_GT(median, 1.3) << "sigma more than twice too large";
  EXPECT_LT(median, 11) << "sigma more than 1.4 times too small";
}

}  // namespace
}  // namespace edgepose
