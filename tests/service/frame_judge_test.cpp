#include "server/frame_judge.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace edgepose {
namespace {

constexpr int64_t kNow = 1'700'000'000'000'000, kFrame = 33'333;

class FrameJudging : public testing::Test {
 protected:
  /// A frame that arrives 5 ms after it was taken.
  FrameVerdict at(int64_t sequence, int64_t capture) {
    return judge_.judge("a", sequence, capture, capture + 5000, {});
  }
  FrameJudge judge_;
};

TEST_F(FrameJudging, TakesFramesThatFollowEachOther) {
  for (int i = 0; i < 100; ++i) {
    const FrameVerdict verdict = at(i, kNow + i * kFrame);
    EXPECT_EQ(verdict.refusal, "");
    EXPECT_EQ(verdict.lost, 0);
  }
}

TEST_F(FrameJudging, CountsGaps) {
  at(1, kNow);
  EXPECT_EQ(at(5, kNow + 4 * kFrame).lost, 3);
  EXPECT_EQ(at(6, kNow + 5 * kFrame).lost, 0);
}

TEST_F(FrameJudging, WhatWasRefusedIsNotMissing) {
  at(1, kNow);
  EXPECT_TRUE(judge_.skip("a", 2));
  EXPECT_EQ(at(4, kNow + 3 * kFrame).lost, 1) << "only 3 is missing";
  EXPECT_FALSE(judge_.skip("unknown", 1));
}

TEST_F(FrameJudging, TheFutureAndThePastAreRefused) {
  EXPECT_EQ(judge_.judge("a", 1, kNow + 100'000, kNow, {}).refusal, "from_the_future");
  EXPECT_EQ(judge_.judge("a", 1, kNow - 1'100'000, kNow, {}).refusal, "too_old");
  EXPECT_EQ(judge_.judge("a", 1, kNow - 900'000, kNow, {}).refusal, "");
  FrameOptions patient;
  patient.max_age = 10;
  EXPECT_EQ(judge_.judge("b", 1, kNow - 9'000'000, kNow, patient).refusal, "");
}

TEST_F(FrameJudging, ExtremeNumbersOverflowNothing) {
  constexpr int64_t kLeast = std::numeric_limits<int64_t>::min(), kMost = std::numeric_limits<int64_t>::max();
  EXPECT_EQ(judge_.judge("a", kLeast, kLeast, kNow, {}).refusal, "too_old");
  EXPECT_EQ(judge_.judge("a", kMost, kMost, kNow, {}).refusal, "from_the_future");
  EXPECT_EQ(at(kLeast, kNow).refusal, "");
  const FrameVerdict jump = at(kMost, kNow + kFrame);
  EXPECT_EQ(jump.refusal, "");
  EXPECT_EQ(jump.lost, 0);
  EXPECT_TRUE(jump.restarted) << "no camera is so fast";
}

TEST_F(FrameJudging, SequencesThatGoBackAreRefused) {
  at(100, kNow);
  EXPECT_EQ(at(100, kNow + kFrame).refusal, "sequence_went_back");
  EXPECT_EQ(at(99, kNow + kFrame).refusal, "sequence_went_back");
  EXPECT_EQ(at(101, kNow).refusal, "time_went_back");
  EXPECT_EQ(at(101, kNow + 2 * kFrame).refusal, "") << "the camera itself is not disturbed";
}

TEST_F(FrameJudging, ACameraThatWasRestartedIsBelievedTheThirdTime) {
  at(100, kNow);
  EXPECT_EQ(at(0, kNow + kFrame).refusal, "sequence_went_back");
  EXPECT_EQ(at(1, kNow + 2 * kFrame).refusal, "sequence_went_back");
  const FrameVerdict third = at(2, kNow + 3 * kFrame);
  EXPECT_EQ(third.refusal, "");
  EXPECT_TRUE(third.restarted);
  EXPECT_EQ(at(3, kNow + 4 * kFrame).refusal, "");
}

TEST_F(FrameJudging, HigherNumbersThanTimeAllowsAreARestart) {
  at(1, kNow);
  const FrameVerdict later = at(2501, kNow + 2'500'000);  // as another program that counts milliseconds
  EXPECT_TRUE(later.restarted);
  EXPECT_EQ(later.lost, 0);
  EXPECT_EQ(at(2576, kNow + 5'000'000).lost, 74) << "30 frames a second for 2.5 s are a loss";
}

TEST_F(FrameJudging, AClockSetBackIsBelievedTheThirdTime) {
  at(100, kNow);
  constexpr int64_t kHour = 3'600'000'000;
  EXPECT_EQ(at(101, kNow - kHour).refusal, "time_went_back");
  EXPECT_EQ(at(102, kNow - kHour + kFrame).refusal, "time_went_back");
  EXPECT_TRUE(at(103, kNow - kHour + 2 * kFrame).restarted);
}

TEST_F(FrameJudging, TheSameOldFrameAgainAndAgainIsNeverBelieved) {
  at(100, kNow);
  for (int i = 0; i < 50; ++i) EXPECT_NE(at(50, kNow - 50 * kFrame).refusal, "");
}

TEST_F(FrameJudging, OnlySoManyCamerasAtOnce) {
  const FrameOptions options;
  for (int i = 0; i < options.max_cameras; ++i)
    EXPECT_EQ(judge_.judge("camera" + std::to_string(i), 1, kNow, kNow, options).refusal, "");
  EXPECT_EQ(judge_.judge("one more", 1, kNow, kNow, options).refusal, "too_many_cameras");
  const int64_t later = kNow + 11'000'000;
  EXPECT_EQ(judge_.judge("one more", 1, later, later, options).refusal, "") << "silent ones make room";
}

/// Whatever comes, what is taken rises in number and time, but for restarts.
TEST(FrameJudgeProperty, TakenFramesRise) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    FrameJudge judge;
    int64_t sequence = 0, capture = 0;
    bool first = true;
    for (int i = 0; i < 2000; ++i) {
      const auto s = static_cast<int64_t>(random() % 50);
      const int64_t c = kNow + static_cast<int64_t>(random() % 900'000);
      const FrameVerdict verdict = judge.judge("a", s, c, kNow + 900'000, {});
      if (!verdict.refusal.empty()) continue;
      if (!first && !verdict.restarted) {
        EXPECT_GT(s, sequence);
        EXPECT_GT(c, capture);
      }
      first = false, sequence = s, capture = c;
    }
  }
}

}  // namespace
}  // namespace edgepose
