#include "client/service/pose_comparison.h"

#include <gtest/gtest.h>

#include <numbers>

#include "client/service/answer_pairs.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

LoggedPose pose(double x, double turn = 0) {
  RigidTransform transform = RigidTransform::Identity();
  transform.translation().x() = x;
  transform.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  LoggedPose logged{to_message(transform), transform, {}};
  return logged;
}

LoggedAnswer answer(int64_t sequence, const std::vector<LoggedPose>& poses) {
  return {sequence, {{"part", poses}}};
}

/// `count` answers from `first` on; the pose tells which image it was.
std::vector<LoggedAnswer> run(int64_t first, int count, int first_image = 0) {
  std::vector<LoggedAnswer> answers;
  for (int i = 0; i < count; ++i) answers.push_back(answer(first + i, {pose(0.001 * (first_image + i))}));
  return answers;
}

AnswerLog log(std::vector<LoggedAnswer> answers) {
  AnswerLog made;
  made.cameras["camera"].answers = std::move(answers);
  return made;
}

TEST(AnswerPairs, AnOffsetOfTheNumbersDoesNotMatter) {
  const auto a = run(100, 10), b = run(1'700'000'000'000, 10);
  const AnswerPairs pairs = pair_answers(a, b);
  ASSERT_EQ(pairs.both.size(), 10u);
  EXPECT_EQ(pairs.only_a + pairs.only_b, 0u);
  for (const auto& [first, second] : pairs.both) EXPECT_TRUE(same_bits(*first, *second));
}

TEST(AnswerPairs, WhatIsMissingIsFoundOut) {
  auto a = run(100, 10), b = run(5000, 10);
  a.erase(a.begin());      // the first
  b.erase(b.begin() + 5);  // one in between
  const AnswerPairs pairs = pair_answers(a, b);
  EXPECT_EQ(pairs.both.size(), 8u);
  EXPECT_EQ(pairs.only_a, 1u);
  EXPECT_EQ(pairs.only_b, 1u);
  for (const auto& [first, second] : pairs.both) EXPECT_EQ(second->sequence - first->sequence, 4900);
}

TEST(AnswerPairs, OfOffsetsThatFitEquallyTheOneWithTheSameBits) {
  const auto a = run(100, 9, 1), b = run(5000, 10);  // a lacks the first image
  const AnswerPairs pairs = pair_answers(a, b);
  ASSERT_EQ(pairs.both.size(), 9u);
  for (const auto& [first, second] : pairs.both) EXPECT_TRUE(same_bits(*first, *second));
}

TEST(AnswerPairs, ByOrderWhereNumbersDoNotRise) {
  auto a = run(100, 4);
  a[2].sequence = 7;
  const auto b = run(5000, 5);
  const AnswerPairs pairs = pair_answers(a, b);
  EXPECT_EQ(pairs.both.size(), 4u);
  EXPECT_EQ(pairs.only_b, 1u);
  auto far = run(100, 2);
  far[0].sequence = INT64_MIN, far[1].sequence = INT64_MAX;
  EXPECT_EQ(pair_answers(far, b).both.size(), 2u);
}

TEST(PoseComparison, EqualLogsAreEqualBitForBit) {
  const Comparison result = compare_logs(log(run(1, 5)), log(run(900, 5)));
  EXPECT_TRUE(result.is_bit_equal());
  EXPECT_TRUE(result.is_within(0, 0));
  EXPECT_EQ(result.models.at("part").bit_equal, 5u);
}

TEST(PoseComparison, AnswersThatTheDeadlineCutShortAreCounted) {
  auto a = run(100, 5), b = run(200, 5);
  a[1].cut_short = b[1].cut_short = b[3].cut_short = true;
  const Comparison result = compare_logs(log(a), log(b));
  EXPECT_EQ(result.cut_short_a, 1u);
  EXPECT_EQ(result.cut_short_b, 2u);
  EXPECT_TRUE(result.is_bit_equal());
}

TEST(PoseComparison, NothingIsNotEqualToNothing) {
  const auto empty = [] { return log({answer(1, {}), answer(2, {})}); };
  EXPECT_FALSE(compare_logs(empty(), empty()).is_bit_equal());
}

TEST(PoseComparison, OneBitIsADifference) {
  auto b = run(900, 5);
  double& x = b[3].models["part"][0].sent.translation[0];
  x = std::nextafter(x, 1);
  const Comparison result = compare_logs(log(run(1, 5)), log(b));
  EXPECT_FALSE(result.is_bit_equal());
  EXPECT_EQ(result.models.at("part").bit_equal, 4u);
  EXPECT_TRUE(result.is_within(1e-6, 1e-6));
}

TEST(PoseComparison, DifferencesAreMeasured) {
  const auto a = log({answer(1, {pose(0)}), answer(2, {pose(0)}), answer(3, {pose(0)})});
  const auto b = log({answer(1, {pose(0.001)}), answer(2, {pose(0, 2 * kDegree)}), answer(3, {pose(0)})});
  const ModelComparison model = compare_logs(a, b).models.at("part");
  EXPECT_NEAR(*std::max_element(model.translation.begin(), model.translation.end()), 0.001, 1e-12);
  EXPECT_NEAR(*std::max_element(model.rotation.begin(), model.rotation.end()), 2 * kDegree, 1e-9);
  EXPECT_TRUE(compare_logs(a, b).is_within(0.0011, 2.1 * kDegree));
  EXPECT_FALSE(compare_logs(a, b).is_within(0.0009, 2.1 * kDegree));
  EXPECT_FALSE(compare_logs(a, b).is_within(0.0011, 1.9 * kDegree));
}

TEST(PoseComparison, PosesThatLookTheSameAreTheSame) {
  LoggedPose half_turn = pose(0, std::numbers::pi);
  half_turn.equivalent = {pose(0).camera_T_model};
  const Comparison result = compare_logs(log({answer(1, {pose(0)})}), log({answer(1, {half_turn})}));
  EXPECT_TRUE(result.is_within(1e-9, 1e-9));
  EXPECT_FALSE(result.is_bit_equal());
}

TEST(PoseComparison, WhatIsFoundInOneOnlyIsADifference) {
  const auto a = log({answer(1, {pose(0), pose(1)}), answer(2, {})});
  const auto b = log({answer(1, {pose(1)}), answer(2, {pose(0)})});
  const Comparison result = compare_logs(a, b);
  const ModelComparison& model = result.models.at("part");
  EXPECT_EQ(model.poses, 1u);
  EXPECT_EQ(model.only_a, 1u);
  EXPECT_EQ(model.only_b, 1u);
  EXPECT_FALSE(result.is_within(1e9, 4));
}

TEST(PoseComparison, ACameraInOneLogOnlyHasNoPartner) {
  AnswerLog b = log(run(1, 3));
  b.cameras["other"].answers = run(1, 2);
  const Comparison result = compare_logs(log(run(1, 3)), b);
  EXPECT_EQ(result.only_b, 2u);
  EXPECT_FALSE(result.is_bit_equal());
}

}  // namespace
}  // namespace edgepose
