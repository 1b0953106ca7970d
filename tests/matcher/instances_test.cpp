#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "matcher/match.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket;
using fixtures::bracket_model;

RigidTransform placed(double x, double turn) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = (Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(2.6, Eigen::Vector3d(1, 0.4, 0).normalized()))
                      .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, 0, 0.33) - pose.linear() * bracket_model().centre();
  return pose;
}

/// Two brackets side by side before a wall.
Scene two_brackets() {
  const fixtures::Plane wall = {{0, 0, -1}, -0.45};
  DepthImage image = fixtures::render(wall, bracket(), placed(-0.065, 0.3));
  const DepthImage other = fixtures::render(wall, bracket(), placed(0.065, 2.0));
  for (size_t i = 0; i < image.depth.size(); ++i) image.depth[i] = std::min(image.depth[i], other.depth[i]);
  return prepare_scene(image, fixtures::kCamera);
}

TEST(Instances, EachIsReportedOnceAndIsNoRivalOfTheOther) {
  MatchOptions options;
  options.max_instances = 5;
  const MatchResult result = match(two_brackets(), bracket_model(), options);
  size_t left = 0, right = 0;
  for (const Detection& d : result.detections) {
    if (!d.accepted) continue;
    const Eigen::Vector3d at = d.camera_T_model * bracket_model().centre();
    left += (at - placed(-0.065, 0.3) * bracket_model().centre()).norm() < 0.01;
    right += (at - placed(0.065, 2.0) * bracket_model().centre()).norm() < 0.01;
    EXPECT_GT(d.margin, 0.1);
  }
  EXPECT_EQ(left, 1u);
  EXPECT_EQ(right, 1u);
}

TEST(Conflicts, OfTwoModelsForOneThingTheOneThatExplainsMoreStays) {
  // A bracket whose long arm ends early: explains less of what the whole one left in the image.
  Mesh part = bracket();
  for (auto& p : part.vertices) p.x() = std::min(p.x(), 0.055f);
  const Model shorter = train_model(part, "shorter", fixtures::quick_training());
  const Scene scene = two_brackets();
  std::vector<MatchResult> results = {match(scene, shorter), match(scene, bracket_model())};
  ASSERT_FALSE(results[0].detections.empty());
  ASSERT_TRUE(results[1].detections.at(0).accepted);
  // Where the shorter one was found does not matter here, only that it claims the same surface.
  results[0].detections[0] = results[1].detections[0];
  resolve_conflicts(scene, {&shorter, &bracket_model()}, {}, results);
  EXPECT_TRUE(results[1].detections[0].accepted);
  EXPECT_FALSE(results[0].detections[0].accepted);
  EXPECT_THAT(results[0].reason, testing::HasSubstr("bracket"));
}

TEST(Instances, AnAcceptedOneComesFirstAndAReasonIsGivenOnlyIfThereIsNone) {
  // Thresholds just below and above each score that is reported, where the verdict before and after the last
  // refinement may differ.
  const Scene scene = two_brackets();
  MatchOptions options;
  options.max_instances = 5;
  options.accept_score = 0.01f;
  for (const Detection& d : match(scene, bracket_model(), options).detections)
    for (const double above : {-1e-3, 1e-3}) {
      options.accept_score = std::clamp(static_cast<float>(d.score + above), 0.f, 1.f);
      const MatchResult result = match(scene, bracket_model(), options);
      ASSERT_FALSE(result.detections.empty());
      const auto accepted = [](const Detection& each) { return each.accepted; };
      EXPECT_TRUE(std::is_partitioned(result.detections.begin(), result.detections.end(), accepted));
      EXPECT_EQ(result.reason.empty(), result.detections[0].accepted) << options.accept_score;
    }
}

TEST(Conflicts, ThePapersModesAlwaysAnswer) {
  const Scene scene = two_brackets();
  MatchOptions options;
  options.verification = Verification::kPaper;
  std::vector<MatchResult> results(2, match(scene, bracket_model(), options));
  resolve_conflicts(scene, {&bracket_model(), &bracket_model()}, options, results);
  EXPECT_TRUE(results[0].detections.at(0).accepted);
  EXPECT_TRUE(results[1].detections.at(0).accepted);
}

TEST(Conflicts, WhatIsLeftComesFirstAndNeedsNoReason) {
  const Scene scene = two_brackets();
  std::vector<MatchResult> results(2, match(scene, bracket_model()));
  ASSERT_TRUE(results[0].detections.at(0).accepted);
  // The second answer claims the other bracket as well, after the one that the first answer has.
  Detection other = results[0].detections[0];
  const bool found_left = (other.camera_T_model * bracket_model().centre()).x() < 0;
  other.camera_T_model = found_left ? placed(0.065, 2.0) : placed(-0.065, 0.3);
  results[1].detections.push_back(other);
  const Model same = train_model(bracket(), "same", fixtures::quick_training());
  resolve_conflicts(scene, {&bracket_model(), &same}, {}, results);
  EXPECT_TRUE(results[0].detections[0].accepted);
  ASSERT_EQ(results[1].detections.size(), 2u);
  EXPECT_TRUE(results[1].detections[0].accepted);
  EXPECT_TRUE(results[1].detections[0].camera_T_model.isApprox(other.camera_T_model));
  EXPECT_FALSE(results[1].detections[1].accepted);
  EXPECT_EQ(results[1].reason, "");
}

}  // namespace
}  // namespace edgepose
