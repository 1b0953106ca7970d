#include "simulator/pose_source.h"

#include <gtest/gtest.h>

#include "arm/rigid_motion.h"
#include "common/error.h"
#include "messaging/checked_decode.h"
#include "messaging/transform_message.h"
#include "tests/simulator/cell.h"

namespace edgepose {
namespace {

constexpr int64_t kNow = 1'800'000'000'000'000, kSecond = 1'000'000;

class PoseSourceTest : public testing::Test {
 protected:
  using Messages = std::vector<OutgoingMessage>;

  Messages next(PoseWrong wrong = PoseWrong::kNone) {
    source.set_wrong(wrong, 1);
    now += kSecond / 30;
    return source.messages(truth, now - 1000, now);
  }
  edgepose_lcm::pose_estimates_t poses_of(const Messages& messages) {
    edgepose_lcm::pose_estimates_t poses{};
    EXPECT_EQ(messages.at(0).channel, "EDGEPOSE_POSES");
    EXPECT_EQ(decode_checked(messages.at(0).bytes, poses), "");
    return poses;
  }
  edgepose_lcm::rigid_transform_t pose_of(const Messages& messages) {
    return poses_of(messages).answers.at(0).detections.at(0).camera_T_model;
  }
  /// [us] of the capture that the next answer claims, after the true one.
  int64_t ahead_of_truth(PoseWrong wrong) {
    const int64_t claimed = poses_of(next(wrong)).capture_utime;
    return claimed - (now - 1000);
  }
  /// Both messages are judged alike.
  Authenticity judged(const Messages& messages) {
    const Authenticity first = verifier.judge(messages.at(0).channel, messages.at(0).bytes);
    EXPECT_EQ(verifier.judge(messages.at(1).channel, messages.at(1).bytes), first);
    return first;
  }

  const WorkCell cell = phantom_cell();
  const RigidTransform truth = camera_T_model(cell, cell.nominal);
  const SecretKey key = SecretKey::random();
  PoseSource source{cell.plan, key};
  MessageVerifier verifier{key};
  int64_t now = kNow;
};

TEST_F(PoseSourceTest, SaysTheTruthSigned) {
  const Messages messages = next();
  EXPECT_EQ(judged(messages), Authenticity::kGenuine);
  const auto poses = poses_of(messages);
  EXPECT_EQ(poses.capture_utime, now - 1000);
  EXPECT_EQ(poses.sequence, 1);
  EXPECT_EQ(poses.answers[0].model, "vertebra_phantom");
  EXPECT_TRUE(poses.answers[0].detections[0].accepted);
  EXPECT_TRUE(from_message(pose_of(messages))->isApprox(truth, 1e-9));
  edgepose_lcm::drill_targets_t targets{};
  ASSERT_EQ(messages.at(1).channel, "EDGEPOSE_DRILL_TARGETS");
  ASSERT_EQ(decode_checked(messages.at(1).bytes, targets), "");
  ASSERT_EQ(targets.targets.size(), 3u);
  const Eigen::Vector3d entry = truth * cell.plan.targets[0].entry;
  EXPECT_NEAR(targets.targets[0].entry[2], entry.z(), 1e-9);
  EXPECT_TRUE(targets.targets[0].go);
}

TEST_F(PoseSourceTest, WrongTimes) {
  EXPECT_EQ(ahead_of_truth(PoseWrong::kOld), -2 * kSecond);
  EXPECT_EQ(ahead_of_truth(PoseWrong::kFuture), kSecond + 1000) << "a second ahead of the clock";
  EXPECT_EQ(ahead_of_truth(PoseWrong::kNone), 0) << "only as often as was asked for";
  EXPECT_EQ(ahead_of_truth(PoseWrong::kHourStep), 3600 * kSecond);
  EXPECT_EQ(ahead_of_truth(PoseWrong::kNone), 3600 * kSecond) << "for good";
}

TEST_F(PoseSourceTest, WrongPoses) {
  const auto off = [&](PoseWrong wrong) {
    const auto pose = from_message(pose_of(next(wrong)));
    EXPECT_TRUE(pose);
    return RigidTransform(truth.inverse() * pose.value_or(truth));
  };
  EXPECT_NEAR(off(PoseWrong::kJump50mm).translation().norm(), 0.05, 1e-9);
  EXPECT_NEAR(rotation_angle(off(PoseWrong::kTurn20)), 0.34906585, 1e-6);
  EXPECT_NEAR(rotation_angle(off(PoseWrong::kTurn180)), 3.14159265, 1e-6);
  for (const PoseWrong wrong : {PoseWrong::kNan, PoseWrong::kNotOrthonormal, PoseWrong::kZeroQuaternion}) {
    const Messages messages = next(wrong);
    EXPECT_EQ(judged(messages), Authenticity::kGenuine) << name_of(wrong);
    EXPECT_FALSE(from_message(pose_of(messages))) << name_of(wrong);
  }
  const auto long_one = pose_of(next(PoseWrong::kNotOrthonormal));
  EXPECT_NEAR(Eigen::Map<const Eigen::Vector4d>(long_one.quaternion).norm(), 1.1, 1e-9);
}

TEST_F(PoseSourceTest, WrongSignatures) {
  const Messages first = next();
  EXPECT_EQ(judged(first), Authenticity::kGenuine);
  EXPECT_EQ(judged(next(PoseWrong::kUnsigned)), Authenticity::kUnsigned);
  EXPECT_EQ(judged(next(PoseWrong::kAltered)), Authenticity::kAltered);
  const Messages replayed = next(PoseWrong::kReplayed);
  EXPECT_EQ(judged(replayed), Authenticity::kReplayed);
  EXPECT_EQ(replayed.at(0).bytes, first.at(0).bytes);
  EXPECT_EQ(judged(next()), Authenticity::kGenuine);
}

TEST_F(PoseSourceTest, AlteredDiffersInOneByte) {
  PoseSource genuine(cell.plan, key), altered(cell.plan, key);
  altered.set_wrong(PoseWrong::kAltered);
  const Messages a = genuine.messages(truth, kNow, kNow), b = altered.messages(truth, kNow, kNow);
  int differing = 0;
  for (size_t i = 0; i < a[0].bytes.size(); ++i) differing += a[0].bytes[i] != b[0].bytes[i];
  EXPECT_EQ(differing, 1);
}

TEST_F(PoseSourceTest, DuplicateIsTheSameContentAndSilentIsNothing) {
  EXPECT_TRUE(next(PoseWrong::kDuplicate).empty()) << "nothing to repeat yet";
  const auto first = poses_of(next());
  const Messages again = next(PoseWrong::kDuplicate);
  EXPECT_EQ(judged(again), Authenticity::kGenuine);
  EXPECT_EQ(poses_of(again).sequence, first.sequence);
  EXPECT_EQ(poses_of(again).capture_utime, first.capture_utime);
  EXPECT_TRUE(next(PoseWrong::kSilent).empty());
  EXPECT_FALSE(next().empty());
  EXPECT_GT(poses_of(next()).sequence, first.sequence);
}

TEST_F(PoseSourceTest, NoiseIsAsLargeAsItSays) {
  PoseSourceOptions options;
  options.sigma = 0.0005;
  PoseSource noisy(cell.plan, std::nullopt, options);
  double squares = 0;
  for (int i = 0; i < 500; ++i) {
    const auto pose = from_message(pose_of(noisy.messages(truth, kNow + i, kNow + i)));
    squares += (pose->translation() - truth.translation()).squaredNorm() / 3;
  }
  EXPECT_NEAR(std::sqrt(squares / 500), 0.0005, 0.00005);
}

TEST(PoseWrongNames, EachHasOne) {
  for (int i = 0; i < static_cast<int>(PoseWrong::kCount); ++i)
    EXPECT_EQ(pose_wrong_named(name_of(static_cast<PoseWrong>(i))), static_cast<PoseWrong>(i));
  EXPECT_FALSE(pose_wrong_named("wrong"));
}

}  // namespace
}  // namespace edgepose
