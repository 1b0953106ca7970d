#include "server/answer_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "files/mesh_file.h"
#include "messaging/checked_decode.h"
#include "messaging/lcm_publisher.h"
#include "messaging/transform_message.h"
#include "planning/symmetry_doubt.h"
#include "tests/service/moving_scene.h"

namespace edgepose {
namespace {

struct Example {
  WaitingFrame frame;
  FrameAnswer answer;
  std::shared_ptr<RegisteredModel> model;
};

Example example() {
  static const Model phantom = train_model(read_mesh(test::phantom_file("phantom.ply")), "phantom");
  auto model = std::make_shared<RegisteredModel>(RegisteredModel{"vertebra", phantom});
  model->content_hash = -5;
  model->plan = read_drill_plan(test::phantom_file("drill_plan.json"));
  Example e{{}, {}, model};
  e.frame.depth.camera = "camera";
  e.frame.depth.sequence = 42;
  e.frame.dropped = {{"superseded", 3}};
  Detection d;
  d.camera_T_model.translation() = Eigen::Vector3d(0.1, -0.2, 0.5);
  d.camera_T_model.linear() = Eigen::AngleAxisd(3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  d.accepted = true;
  d.score = 0.9;
  d.margin = 0.5;
  d.covariance = 1e-8 * Eigen::Matrix<double, 6, 6>::Identity();
  MatchResult result;
  result.detections = {d};
  e.answer.models = {{model, AnswerMode::kDetection, result}};
  return e;
}

TEST(AnswerMessages, EverythingIsSaid) {
  const Example e = example();
  const auto m = to_poses(e.frame, e.answer);
  EXPECT_EQ(m.sequence, 42);
  ASSERT_EQ(m.dropped_count, 1);
  EXPECT_EQ(m.dropped[0].name, "superseded");
  EXPECT_EQ(m.dropped[0].value, 3);
  ASSERT_EQ(m.answers_count, 1);
  EXPECT_EQ(m.answers[0].model, "vertebra");
  EXPECT_EQ(m.answers[0].content_hash, -5);
  const auto pose = from_message(m.answers[0].detections.at(0).camera_T_model);
  ASSERT_TRUE(pose);
  EXPECT_TRUE(pose->isApprox(e.answer.models[0].result.detections[0].camera_T_model, 1e-12));
  EXPECT_GE(m.answers[0].detections[0].camera_T_model.quaternion[0], 0);
  edgepose_lcm::pose_estimates_t back;
  EXPECT_EQ(decode_checked(encode(m), back), "");
  EXPECT_EQ(back.answers[0].detections[0].covariance[5][5], 1e-8);
}

TEST(AnswerMessages, TargetsAreCarriedToTheCamera) {
  const Example e = example();
  const auto m = to_drill_targets(e.frame, e.answer);
  const DrillPlan& plan = *e.model->plan;
  ASSERT_EQ(m.targets.size(), plan.targets.size());
  const RigidTransform& pose = e.answer.models[0].result.detections[0].camera_T_model;
  for (size_t i = 0; i < plan.targets.size(); ++i) {
    const Eigen::Vector3d entry = pose * plan.targets[i].entry, axis = pose.linear() * plan.targets[i].axis;
    EXPECT_TRUE(entry.isApprox(Eigen::Map<const Eigen::Vector3d>(m.targets[i].entry), 1e-12));
    EXPECT_TRUE(axis.isApprox(Eigen::Map<const Eigen::Vector3d>(m.targets[i].axis), 1e-12));
    EXPECT_TRUE(m.targets[i].go) << m.targets[i].reason;
  }
  edgepose_lcm::drill_targets_t back;
  EXPECT_EQ(decode_checked(encode(m), back), "");
}

TEST(AnswerMessages, DoubtIsNoGo) {
  Example e = example();
  e.answer.models[0].result.detections[0].covariance = Eigen::Matrix<double, 6, 6>::Identity();
  for (const auto& target : to_drill_targets(e.frame, e.answer).targets) {
    EXPECT_FALSE(target.go);
    EXPECT_NE(target.reason.find("the plan allows"), std::string::npos) << target.reason;
  }
  e.answer.models[0].result.detections[0].covariance.setZero();
  for (const auto& target : to_drill_targets(e.frame, e.answer).targets) EXPECT_FALSE(target.go) << "unknown";
  e.answer.models[0].result.detections[0].accepted = false;
  EXPECT_TRUE(to_drill_targets(e.frame, e.answer).targets.empty());
}

/// The reason of the first hole, as it is published; empty: go.
std::string reason_in(const Example& e, double age = 0) {
  const auto m = to_drill_targets(e.frame, e.answer, {}, age);
  EXPECT_EQ(m.targets.at(0).go, m.targets.at(0).reason.empty());
  return m.targets.at(0).reason;
}

TEST(AnswerMessages, WhatWasNotLookedAtInFullIsNoGo) {
  Example e = example();
  EXPECT_EQ(reason_in(e), "");
  EXPECT_THAT(reason_in(e, 1.5), testing::HasSubstr("frames.max_age"));
  e.answer.deadline_reached = true;
  EXPECT_THAT(reason_in(e), testing::HasSubstr("deadline"));
}

TEST(AnswerMessages, ARivalOfNearlyTheSameScoreIsNoGo) {
  Example e = example();
  e.answer.models[0].result.detections[0].margin = 0.05;
  EXPECT_THAT(reason_in(e), testing::HasSubstr("targets.min_margin"));
}

/// A hole that a symmetry moves, and onto nothing of the plan, may be in either place.
TEST(SymmetryDoubt, OfHolesThatASymmetryMoves) {
  DrillPlan plan;
  plan.targets.resize(1);
  DrillTarget& hole = plan.targets[0];
  hole.entry = {0.02, 0, 0.01};
  hole.axis = {0, 0, -1};
  hole.depth = 0.01;
  hole.position_tolerance = 0.001;
  hole.angle_tolerance = 0.02;
  Symmetries half_turn;
  half_turn.discrete.emplace_back(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
  Symmetries round;
  round.continuous.push_back({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()});
  EXPECT_FALSE(is_ambiguous(hole, plan, {}));
  EXPECT_TRUE(is_ambiguous(hole, plan, half_turn));
  EXPECT_TRUE(is_ambiguous(hole, plan, round));

  DrillPlan pair = plan;
  pair.targets.push_back(hole);
  pair.targets[1].entry.x() = -0.02;
  EXPECT_FALSE(is_ambiguous(pair.targets[0], pair, half_turn)) << "the holes change places";
  pair.targets[1].diameter = hole.diameter + 0.001;
  EXPECT_TRUE(is_ambiguous(pair.targets[0], pair, half_turn)) << "but not if they differ";

  DrillPlan middle = plan;
  middle.targets[0].entry = {0, 0, 0.01};
  EXPECT_FALSE(is_ambiguous(middle.targets[0], middle, half_turn));
  EXPECT_FALSE(is_ambiguous(middle.targets[0], middle, round)) << "on the axis";
}

TEST(TransformMessage, WhatIsNoPoseIsRefused) {
  auto m = to_message(RigidTransform::Identity());
  EXPECT_TRUE(from_message(m));
  auto bad = m;
  bad.quaternion[0] = 0;
  EXPECT_FALSE(from_message(bad));
  bad = m;
  bad.quaternion[1] = NAN;
  EXPECT_FALSE(from_message(bad));
  bad = m;
  bad.translation[2] = INFINITY;
  EXPECT_FALSE(from_message(bad));
  bad = m;
  bad.quaternion[0] = 1.001;
  EXPECT_FALSE(from_message(bad));
}

}  // namespace
}  // namespace edgepose
