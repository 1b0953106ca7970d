#include "client/service/truth_comparison.h"

#include <gtest/gtest.h>

#include <numbers>

#include "client/service/symmetric_error.h"
#include "common/error.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

/// The project's own small set, and answers to its images.
class Truth : public testing::Test {
 protected:
  LoggedAnswer answer(int64_t sequence, const RigidTransform& off = RigidTransform::Identity()) const {
    LoggedAnswer made{sequence, {}};
    const auto& image = set_.images[static_cast<size_t>(sequence - 500) % set_.images.size()];
    for (const GroundTruth& truth : image.truth) {
      const RigidTransform pose = off * truth.camera_T_model;
      made.models[set_.objects[0].name].push_back({to_message(pose), pose, {}});
    }
    return made;
  }
  CameraAnswers all() const {
    CameraAnswers answers;
    for (size_t i = 0; i < 2 * set_.images.size(); ++i)
      answers.answers.push_back(answer(500 + static_cast<int64_t>(i)));
    return answers;
  }
  TruthComparison compare(const CameraAnswers& answers) const {
    return compare_with_truth(answers, set_, make_pose_errors(set_));
  }
  std::filesystem::path folder_ = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models/sample_set";
  TestSet set_ = read_truth(folder_ / "test/000001");
};

TEST_F(Truth, PerfectAnswersAreWithinAllOfIt) {
  const TruthComparison result = compare(all());
  const TruthModel& model = result.models.at(set_.objects[0].name);
  EXPECT_EQ(result.answers, 2 * set_.images.size());
  EXPECT_GT(model.instances, 0u);
  EXPECT_EQ(model.within(0.05), model.instances);
  EXPECT_TRUE(result.all_within(0.1));
}

TEST_F(Truth, ErrorsAreMeasured) {
  CameraAnswers answers = all();
  RigidTransform off = RigidTransform::Identity();
  off.translation().x() = 0.07 * set_.objects[0].diameter;
  answers.answers[0] = answer(500, off);
  const TruthComparison result = compare(answers);
  const TruthModel& model = result.models.at(set_.objects[0].name);
  EXPECT_LT(model.within(0.05), model.instances);
  EXPECT_EQ(model.within(0.1), model.instances);
  EXPECT_NEAR(model.translation[0], 0.07 * model.diameter, 1e-9);
}

TEST_F(Truth, WhatIsMissedOrNotThereCounts) {
  CameraAnswers missed = all(), extra = all(), unanswered = all();
  missed.answers[0].models.begin()->second.clear();
  EXPECT_FALSE(compare(missed).all_within(0.1));
  auto& poses = extra.answers[0].models.begin()->second;
  poses.push_back(poses.front());
  EXPECT_EQ(compare(extra).models.begin()->second.extra, 1u);
  EXPECT_FALSE(compare(extra).all_within(0.1));
  unanswered.answers.erase(unanswered.answers.begin() + 2);
  EXPECT_EQ(compare(unanswered).unanswered, 1u);
  EXPECT_EQ(compare(unanswered).models.begin()->second.within(0.05),
            compare(unanswered).models.begin()->second.instances);
}

TEST_F(Truth, TheFirstFrameMayBeUnanswered) {
  CameraAnswers answers = all();
  answers.answers.erase(answers.answers.begin());
  answers.first_frame = 500;
  const TruthComparison result = compare(answers);
  EXPECT_EQ(result.unanswered, 1u);
  EXPECT_EQ(result.models.begin()->second.within(0.05), result.models.begin()->second.instances);
}

TEST_F(Truth, OtherModelsAndFoldersAreRefused) {
  CameraAnswers answers = all();
  answers.answers[0].models["stranger"];
  EXPECT_THROW(compare(answers), InputError);
  EXPECT_THROW(read_truth(folder_ / "test"), InputError);
  EXPECT_THROW(read_truth(folder_ / "nothing"), InputError);
  EXPECT_EQ(read_truth(folder_).images.size(), set_.images.size());
}

TEST(SymmetricErrors, OnlyWhatCanBeSeenCounts) {
  const RigidTransform truth = RigidTransform::Identity();
  RigidTransform turned = truth;
  turned.linear() = Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_NEAR(symmetric_error({}, truth, turned).rotation, 2, 1e-9);
  Symmetries round{{}, {{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}}};
  EXPECT_NEAR(symmetric_error(round, truth, turned).rotation, 0, 1e-9);
  RigidTransform over = truth;
  over.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(symmetric_error(round, truth, over).rotation, std::numbers::pi, 1e-9);
  round.discrete.push_back(over);
  EXPECT_NEAR(symmetric_error(round, truth, over).rotation, 0, 1e-9);
  const Symmetries half{{over}, {}};
  EXPECT_NEAR(symmetric_error(half, truth, over).rotation, 0, 1e-6);
  EXPECT_NEAR(symmetric_error(half, truth, turned).rotation, 2, 1e-9);
}

}  // namespace
}  // namespace edgepose
