#include "client/service/frame_restamp.h"

#include <gtest/gtest.h>

#include "messaging/channels.h"
#include "messaging/checked_decode.h"
#include "messaging/depth_message.h"
#include "messaging/lcm_publisher.h"

namespace edgepose {
namespace {

using Outcome = FrameRestamp::Outcome;

edgepose_lcm::depth_frame_t frame(const std::string& camera, int64_t sequence) {
  DepthFrame made{1000 + sequence, sequence, camera, {6, 6, 1, 1}, {4, 2, {1, 2, 3, 4, 0, 6, 7, 8}}};
  return pack(made, 0.001, DepthEncoding::kRvl);
}

edgepose_lcm::depth_frame_t restamped(FrameRestamp& restamp, const edgepose_lcm::depth_frame_t& message,
                                      int64_t now) {
  auto bytes = encode(message);
  EXPECT_EQ(restamp.restamp(channels::kDepth, now, bytes), Outcome::kDone);
  edgepose_lcm::depth_frame_t changed;
  EXPECT_EQ(decode_checked(std::span<const std::byte>(bytes), changed), "");
  return changed;
}

TEST(FrameRestamp, NumbersMoveTogetherAndTheRestStays) {
  FrameRestamp restamp(5'000'000);
  const auto logged = frame("left", 70);
  const auto first = restamped(restamp, logged, 123);
  EXPECT_EQ(first.sequence, 5'000'000);
  EXPECT_EQ(first.capture_utime, 123);
  EXPECT_EQ(first.data, logged.data);
  EXPECT_EQ(first.checksum, logged.checksum);
  DepthFrame unpacked;
  std::string detail;
  EXPECT_EQ(unpack(first, unpacked, detail), FrameFault::kNone) << detail;
  EXPECT_EQ(restamped(restamp, frame("left", 73), 124).sequence, 5'000'003) << "the gap stays";
  EXPECT_EQ(restamped(restamp, frame("left", 69), 125).sequence, 4'999'999) << "and what went back";
}

TEST(FrameRestamp, EachCameraCountsForItself) {
  FrameRestamp restamp(100);
  EXPECT_EQ(restamped(restamp, frame("left", 7), 1).sequence, 100);
  EXPECT_EQ(restamped(restamp, frame("right", -900), 1).sequence, 100);
  EXPECT_EQ(restamped(restamp, frame("left", 8), 1).sequence, 101);
}

TEST(FrameRestamp, CloudsAsWell) {
  FrameRestamp restamp(100);
  edgepose_lcm::cloud_frame_t cloud{};
  cloud.camera = "scanner";
  cloud.sequence = 4;
  cloud.values = 3;
  cloud.xyz = {1, 2, 3};
  auto bytes = encode(cloud);
  ASSERT_EQ(restamp.restamp(channels::kCloud, 55, bytes), Outcome::kDone);
  edgepose_lcm::cloud_frame_t changed;
  ASSERT_EQ(decode_checked(std::span<const std::byte>(bytes), changed), "");
  EXPECT_EQ(changed.sequence, 100);
  EXPECT_EQ(changed.capture_utime, 55);
  EXPECT_EQ(changed.xyz, cloud.xyz);
}

TEST(FrameRestamp, WhatIsNoFrameStaysAsItIs) {
  FrameRestamp restamp(100);
  std::vector<std::byte> foreign(40, std::byte{7});
  const auto before = foreign;
  EXPECT_EQ(restamp.restamp(channels::kDepth, 1, foreign), Outcome::kMalformed);
  EXPECT_EQ(foreign, before);
  auto depth = encode(frame("left", 1));
  EXPECT_EQ(restamp.restamp("OTHER", 1, depth), Outcome::kMalformed);
}

TEST(FrameRestamp, NumbersThatCannotBeMovedAreTold) {
  FrameRestamp restamp(INT64_MAX - 5);
  restamped(restamp, frame("left", 0), 1);
  auto far = encode(frame("left", 6));
  EXPECT_EQ(restamp.restamp(channels::kDepth, 1, far), Outcome::kBeyond);
  FrameRestamp other(100);
  restamped(other, frame("left", INT64_MIN), 1);
  auto opposite = encode(frame("left", INT64_MAX));
  EXPECT_EQ(other.restamp(channels::kDepth, 1, opposite), Outcome::kBeyond);
}

TEST(FrameIdentity, OfFramesOnly) {
  std::string camera;
  int64_t sequence = 0;
  EXPECT_TRUE(frame_identity(channels::kDepth, encode(frame("left", 42)), camera, sequence));
  EXPECT_EQ(camera, "left");
  EXPECT_EQ(sequence, 42);
  EXPECT_FALSE(frame_identity(channels::kPoses, encode(frame("left", 42)), camera, sequence));
  EXPECT_FALSE(frame_identity(channels::kCloud, encode(frame("left", 42)), camera, sequence));
}

}  // namespace
}  // namespace edgepose
