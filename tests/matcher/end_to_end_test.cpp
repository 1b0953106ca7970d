#include <gtest/gtest.h>

#include <utility>

#include "matcher/match.h"
#include "matcher/model_block.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket;
using fixtures::bracket_model;

/// [m] largest distance between a vertex where it is and where it was found.
double pose_error(const RigidTransform& found, const RigidTransform& truth) {
  double worst = 0;
  for (const auto& p : bracket().vertices)
    worst = std::max(worst, (found * p.cast<double>() - truth * p.cast<double>()).norm());
  return worst;
}

MatchResult match_with(const DepthImage& image, int threads, MatchOptions options = {}) {
  SceneOptions scene;
  scene.threads = threads;
  options.threads = threads;
  return match(prepare_scene(image, fixtures::kCamera, scene), bracket_model(), options);
}

void expect_same_bits(const MatchResult& a, const MatchResult& b) {
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.scene_points, b.scene_points);
  EXPECT_EQ(a.reference_points, b.reference_points);
  EXPECT_EQ(a.candidates, b.candidates);
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (size_t i = 0; i < a.detections.size(); ++i) {
    const Detection &x = a.detections[i], &y = b.detections[i];
    EXPECT_EQ(x.camera_T_model.matrix(), y.camera_T_model.matrix());
    EXPECT_EQ(x.covariance, y.covariance);
    EXPECT_EQ(x.score, y.score);
    EXPECT_EQ(x.accepted, y.accepted);
    EXPECT_EQ(x.edge_score, y.edge_score);
    EXPECT_EQ(x.coverage, y.coverage);
    EXPECT_EQ(x.violations, y.violations);
    EXPECT_EQ(x.margin, y.margin);
    EXPECT_EQ(x.votes, y.votes);
  }
}

class OnTheTable : public testing::TestWithParam<uint64_t> {
 protected:
  OnTheTable() {
    fixtures::Random random(GetParam());
    truth = fixtures::pose_on_table(bracket(), fixtures::table(), random);
    image = fixtures::render(fixtures::table(), bracket(), truth);
  }
  RigidTransform truth;
  DepthImage image;
};

TEST_P(OnTheTable, ASettledSearchEndsEarlierWithTheSamePose) {
  MatchOptions settled;
  settled.search.sure_once = settled.search.sure_twice = settled.search.sure_thrice = 2;
  MatchOptions never = settled;
  never.search.settled = 1e5f;
  const MatchResult early = match_with(image, 2, settled), late = match_with(image, 2, never);
  EXPECT_LT(2 * early.candidates, late.candidates);
  ASSERT_FALSE(early.detections.empty());
  ASSERT_FALSE(late.detections.empty());
  EXPECT_LT(pose_error(early.detections[0].camera_T_model, truth), 0.002);
  EXPECT_LT(pose_error(late.detections[0].camera_T_model, truth), 0.002);
  // Sightings that a search did not wait for must not make a pose look less likely.
  EXPECT_TRUE(early.detections[0].accepted);
  EXPECT_NEAR(early.detections[0].score, late.detections[0].score, 0.1);
}

TEST_P(OnTheTable, IsFoundAndAnyThreadCountSaysTheSame) {
  const MatchResult one = match_with(image, 1);
  ASSERT_FALSE(one.detections.empty()) << one.reason;
  const Detection& best = one.detections[0];
  EXPECT_TRUE(best.accepted) << one.reason;
  EXPECT_EQ(one.reason.empty(), best.accepted);
  EXPECT_LT(pose_error(best.camera_T_model, truth), 0.02 * bracket_model().diameter());
  EXPECT_TRUE(best.covariance.allFinite());
  expect_same_bits(one, match_with(image, 3));
}

TEST_P(OnTheTable, TheEdgeScoreIsWorkedOutOnRequestAndChangesNothingElse) {
  MatchOptions options;
  options.edge_score = true;
  MatchResult plain = match_with(image, 2), with = match_with(image, 2, options);
  ASSERT_FALSE(plain.detections.empty());
  for (Detection& d : plain.detections) EXPECT_FALSE(d.edge_score);
  for (Detection& d : with.detections) {
    ASSERT_TRUE(d.edge_score);
    EXPECT_GT(std::exchange(d.edge_score, std::nullopt), 0.1);
  }
  expect_same_bits(plain, with);
}

TEST_P(OnTheTable, PaperModeGivesADetection) {
  MatchOptions options;
  options.verification = Verification::kPaper;
  const MatchResult one = match_with(image, 1, options);
  ASSERT_FALSE(one.detections.empty()) << one.reason;
  const Detection& best = one.detections[0];
  EXPECT_TRUE(best.camera_T_model.matrix().allFinite());
  EXPECT_NEAR(best.camera_T_model.linear().determinant(), 1, 1e-4);
  ASSERT_TRUE(best.edge_score);
  EXPECT_GE(*best.edge_score, 0);
  EXPECT_LE(*best.edge_score, 1);
  expect_same_bits(one, match_with(image, 3, options));
}

INSTANTIATE_TEST_SUITE_P(Seeds, OnTheTable, testing::Values(1, 2, 3));

TEST(OnlyTheTable, NothingIsAcceptedAndTheReasonIsGiven) {
  const MatchResult result = match_with(fixtures::render(fixtures::table()), 0);
  for (const auto& d : result.detections) EXPECT_FALSE(d.accepted);
  EXPECT_FALSE(result.reason.empty());
}

}  // namespace
}  // namespace edgepose
