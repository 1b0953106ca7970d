#include "controller/pose_inbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "messaging/checked_decode.h"
#include "messaging/lcm_publisher.h"
#include "simulator/pose_source.h"
#include "tests/controller/moving_arm.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;

constexpr int64_t kWall = 1'700'000'000'000'000'000;  // [ns] of the steady clock's zero
constexpr int64_t kCapture = kWall / 1000 + 5'000'000;

struct Inbox : testing::Test {
  RigidTransform pose = camera_T_model(phantom_cell(), phantom_cell().nominal);
  int64_t wall = kWall;
  PoseSource source{phantom_cell().plan, std::nullopt};
  PoseInbox inbox{phantom_cell().plan.model, "", std::nullopt};

  void take(const std::vector<OutgoingMessage>& messages, PoseInbox& by) {
    for (const OutgoingMessage& message : messages) {
      ReceivedMessage one;
      one.channel = message.channel;
      one.size = message.bytes.size();
      one.bytes = std::make_unique<std::byte[]>(one.size);
      std::copy(message.bytes.begin(), message.bytes.end(), one.bytes.get());
      by.take(one, 5'100'000'000, wall);
    }
  }
  std::vector<OutgoingMessage> answer() { return source.messages(pose, kCapture, kCapture + 100'000); }
  std::string fault_of(const std::string& target, double now = 5.1) {
    try {
      inbox.find(target, now);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }
};

TEST_F(Inbox, AnAnswerAndItsTargetsMakeAReadingOnTheSteadyClock) {
  take(answer(), inbox);
  const auto reading = inbox.take_reading();
  ASSERT_TRUE(reading);
  EXPECT_TRUE(reading->camera_T_model.isApprox(pose, 1e-9));
  EXPECT_NEAR(reading->capture_time, 5, 1e-9);
  EXPECT_TRUE(reading->accepted);
  EXPECT_FALSE(inbox.take_reading()) << "it has been taken";
}

TEST_F(Inbox, HolesComeInTheModelsFrame) {
  take(answer(), inbox);
  const DrillTarget& hole = phantom_cell().find_target(kTarget);
  const SeenTarget seen = inbox.find(kTarget, 5.1);
  EXPECT_LT((seen.hole.entry - hole.entry).norm(), 1e-9);
  EXPECT_LT((seen.hole.axis - hole.axis).norm(), 1e-9);
}

TEST_F(Inbox, SaysWhatIsWrongWithATarget) {
  EXPECT_THAT(fault_of(kTarget), HasSubstr("none yet"));
  take(answer(), inbox);
  EXPECT_EQ(fault_of(kTarget), "");
  EXPECT_THAT(fault_of("left_pedicle_scre"), HasSubstr("did you mean left_pedicle_screw?"));
  EXPECT_THAT(fault_of(kTarget, 6.1), HasSubstr("a frame of the last second"));
}

TEST_F(Inbox, AnotherModelsPlanIsNotTaken) {
  PoseInbox other("l4", "", std::nullopt);
  take(answer(), other);
  EXPECT_FALSE(other.take_reading());
  EXPECT_EQ(other.counters().get("frames_without_the_model"), 1u);
  EXPECT_THROW(other.find(kTarget, 5.1), InputError);

  // The same name, but targets of a model file that is not the one whose pose was found.
  PoseSourceOptions options;
  options.content_hash = 2;
  PoseSource genuine(phantom_cell().plan, std::nullopt), another(phantom_cell().plan, std::nullopt, options);
  std::vector<OutgoingMessage> messages = genuine.messages(pose, kCapture, kCapture + 100'000);
  messages[1] = another.messages(pose, kCapture, kCapture + 100'000)[1];
  take(messages, inbox);
  EXPECT_EQ(inbox.counters().get("targets_of_another_model"), 3u);
  EXPECT_THAT(fault_of(kTarget), HasSubstr("none yet"));
}

TEST_F(Inbox, OtherCamerasAreNotListenedTo) {
  PoseInbox left(phantom_cell().plan.model, "left", std::nullopt);
  take(answer(), left);
  EXPECT_FALSE(left.take_reading());
  EXPECT_EQ(left.counters().get("frames_of_other_cameras"), 1u);
}

TEST_F(Inbox, AReadingWithoutTheFollowedHoleIsNotAccepted) {
  take(answer(), inbox);
  inbox.follow(kTarget, inbox.find(kTarget, 5.1).hole);
  take(answer(), inbox);
  EXPECT_TRUE(inbox.take_reading()->accepted);
  DrillPlan less = phantom_cell().plan;
  std::erase_if(less.targets, [](const DrillTarget& target) { return target.name == kTarget; });
  PoseSource without(less, std::nullopt);
  take(without.messages(pose, kCapture, kCapture), inbox);
  EXPECT_FALSE(inbox.take_reading()->accepted);
  DrillPlan moved = phantom_cell().plan;
  for (DrillTarget& target : moved.targets) target.entry.x() += 0.001;
  PoseSource elsewhere(moved, std::nullopt);
  take(elsewhere.messages(pose, kCapture, kCapture), inbox);
  EXPECT_FALSE(inbox.take_reading()->accepted) << "the hole has moved by a millimetre";
}

TEST_F(Inbox, HalvesOfDifferentFramesAreNotPaired) {
  const auto first = answer(), second = answer();
  take({first[0], second[1]}, inbox);
  EXPECT_FALSE(inbox.take_reading());
  EXPECT_EQ(inbox.counters().get("targets_without_answer"), 1u);
}

TEST_F(Inbox, WithAKeyOnlyWhatIsSignedCounts) {
  const SecretKey key = SecretKey::random();
  PoseSourceOptions options;
  options.session = 1'700'000'000'000'000;
  PoseSource signing(phantom_cell().plan, key, options);
  const auto good = [&] { return signing.messages(pose, kCapture, kCapture); };
  PoseInbox careful(phantom_cell().plan.model, "", key);
  take(good(), careful);
  EXPECT_TRUE(careful.take_reading());
  take(answer(), careful);
  EXPECT_EQ(careful.counters().get("messages_unsigned"), 2u);
  for (const PoseWrong wrong : {PoseWrong::kAltered, PoseWrong::kReplayed, PoseWrong::kUnsigned}) {
    signing.set_wrong(wrong, 1);
    take(good(), careful);
  }
  EXPECT_EQ(careful.counters().get("messages_altered"), 2u);
  EXPECT_EQ(careful.counters().get("messages_replayed"), 2u);
  EXPECT_EQ(careful.counters().get("messages_unsigned"), 4u);
  EXPECT_FALSE(careful.take_reading());
}

TEST_F(Inbox, WhatIsNoMessageIsCounted) {
  take({{"EDGEPOSE_POSES", std::vector<std::byte>(40)}}, inbox);
  take({{"EDGEPOSE_DRILL_TARGETS", {}}}, inbox);
  EXPECT_EQ(inbox.counters().get("messages_malformed"), 2u);
}

TEST_F(Inbox, FramesUnderWayWhileTheClockIsSetAreLeftOut) {
  take(answer(), inbox);
  EXPECT_TRUE(inbox.take_reading());
  wall += 50'000'000;  // by 50 ms: few enough for the gate to take it
  take(answer(), inbox);
  EXPECT_FALSE(inbox.take_reading());
  EXPECT_EQ(inbox.counters().get("frames_after_the_clock_was_set"), 1u);
}

TEST_F(Inbox, TwoBonesAreNotFollowed) {
  edgepose_lcm::pose_estimates_t poses;
  std::vector<OutgoingMessage> messages = answer();
  ASSERT_EQ(decode_checked(messages[0].bytes, poses), "");
  poses.answers[0].detections.push_back(poses.answers[0].detections[0]);
  poses.answers[0].detections_count = 2;
  messages[0].bytes = encode(poses);
  take(messages, inbox);
  EXPECT_FALSE(inbox.take_reading()->accepted);
  EXPECT_THAT(fault_of(kTarget), HasSubstr("seen 2 times"));
}

}  // namespace
}  // namespace edgepose::test
