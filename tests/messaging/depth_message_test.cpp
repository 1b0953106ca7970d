#include "messaging/depth_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace edgepose {
namespace {

DepthFrame frame() {
  DepthFrame f;
  f.capture_utime = 1'700'000'000'000'000;
  f.sequence = 42;
  f.camera = "wrist";
  f.intrinsics = {50, 51, 15.5, 11.5};
  f.image.width = 32, f.image.height = 24;
  for (int i = 0; i < 32 * 24; ++i)
    f.image.depth.push_back(i % 7 == 0 ? 0 : 0.4f + 0.001f * static_cast<float>(i % 50));
  return f;
}

class DepthMessage : public testing::TestWithParam<DepthEncoding> {};

TEST_P(DepthMessage, ComesBackToTheScale) {
  const DepthFrame sent = frame();
  DepthFrame got;
  std::string detail;
  ASSERT_EQ(unpack(pack(sent, 1e-4, GetParam()), got, detail), FrameFault::kNone) << detail;
  EXPECT_EQ(got.sequence, 42);
  EXPECT_EQ(got.camera, "wrist");
  EXPECT_EQ(got.intrinsics.fy, 51);
  ASSERT_EQ(got.image.depth.size(), sent.image.depth.size());
  for (size_t i = 0; i < sent.image.depth.size(); ++i)
    EXPECT_NEAR(got.image.depth[i], sent.image.depth[i], 0.51e-4) << i;
}

TEST_P(DepthMessage, EachFaultIsNamed) {
  using Message = edgepose_lcm::depth_frame_t;
  struct Case {
    FrameFault fault;
    std::function<void(Message&)> spoil;
    std::string word;
  };
  const std::vector<Case> cases = {
      {FrameFault::kName, [](Message& m) { m.camera = ""; }, "camera"},
      {FrameFault::kName, [](Message& m) { m.camera = "a\nb"; }, "camera"},
      {FrameFault::kEncoding, [](Message& m) { m.encoding = 9; }, "9"},
      {FrameFault::kSize, [](Message& m) { m.width = 0; }, "0 x 24"},
      {FrameFault::kSize, [](Message& m) { m.height = 5000; }, "5000"},
      {FrameFault::kScale, [](Message& m) { m.depth_scale = 1; }, "depth_scale"},
      {FrameFault::kScale, [](Message& m) { m.depth_scale = std::nan(""); }, "depth_scale"},
      {FrameFault::kIntrinsics, [](Message& m) { m.fx = 0; }, "fx"},
      {FrameFault::kIntrinsics, [](Message& m) { m.cy = std::nan(""); }, "cy"},
      {FrameFault::kChecksum, [](Message& m) { m.data[5] ^= 1; }, "checksum"},
  };
  for (const Case& c : cases) {
    auto message = pack(frame(), 1e-3, GetParam());
    c.spoil(message);
    DepthFrame got;
    std::string detail;
    EXPECT_EQ(unpack(message, got, detail), c.fault) << c.word;
    EXPECT_THAT(detail, testing::HasSubstr(c.word));
    EXPECT_EQ(got.camera, "") << "left as it was";
  }
}

TEST_P(DepthMessage, NothingMeasuredIsAFault) {
  DepthFrame dark = frame();
  for (float& z : dark.image.depth) z = 0;
  DepthFrame got;
  std::string detail;
  EXPECT_EQ(unpack(pack(dark, 1e-3, GetParam()), got, detail), FrameFault::kEmpty);
}

INSTANTIATE_TEST_SUITE_P(Encodings, DepthMessage, testing::Values(DepthEncoding::kRaw16, DepthEncoding::kRvl),
                         [](const auto& encoding) {
                           return encoding.param == DepthEncoding::kRvl ? "Rvl" : "Raw16";
                         });

TEST(RawDepthMessage, DataOfAnotherSizeIsAFault) {
  auto message = pack(frame(), 1e-3, DepthEncoding::kRaw16);
  message.data.pop_back();
  DepthFrame got;
  std::string detail;
  EXPECT_EQ(unpack(message, got, detail), FrameFault::kSize);
  EXPECT_THAT(detail, testing::HasSubstr("1536"));
}

TEST(RvlDepthMessage, DataForAnotherSizeIsAFault) {
  auto message = pack(frame(), 1e-3, DepthEncoding::kRvl);
  message.height += 1;
  DepthFrame got;
  std::string detail;
  EXPECT_EQ(unpack(message, got, detail), FrameFault::kData);
}

TEST(DepthMessageRange, WhatDoesNotFitIsNotMeasured) {
  DepthFrame far = frame();
  far.image.depth[1] = 70, far.image.depth[2] = -1, far.image.depth[3] = std::nanf("");
  DepthFrame got;
  std::string detail;
  ASSERT_EQ(unpack(pack(far, 1e-3, DepthEncoding::kRaw16), got, detail), FrameFault::kNone);
  EXPECT_EQ(got.image.depth[1], 0);
  EXPECT_EQ(got.image.depth[2], 0);
  EXPECT_EQ(got.image.depth[3], 0);
}

}  // namespace
}  // namespace edgepose
