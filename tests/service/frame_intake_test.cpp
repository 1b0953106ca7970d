#include "server/frame_intake.h"

#include <gtest/gtest.h>

#include <functional>

#include "daemon/clock.h"
#include "messaging/lcm_publisher.h"

namespace edgepose {
namespace {

using edgepose_lcm::depth_frame_t;

DepthFrame small_frame(int64_t sequence) {
  DepthFrame frame;
  frame.capture_utime = utime_now();
  frame.sequence = sequence;
  frame.camera = "a";
  frame.intrinsics = {40, 40, 19.5, 14.5};
  frame.image = {40, 30, std::vector<float>(1200, 0.5f)};
  return frame;
}

ReceivedMessage received(const std::string& channel, const std::vector<std::byte>& bytes) {
  ReceivedMessage message{channel, std::make_unique<std::byte[]>(bytes.size()), bytes.size()};
  std::copy(bytes.begin(), bytes.end(), message.bytes.get());
  return message;
}

class Intake : public testing::Test {
 protected:
  void send(const depth_frame_t& message) { intake_.take(received(kDepthChannel, encode(message))); }
  /// What is counted after a sound frame was changed by `spoil`, and a sound one came after it.
  void expect_refused(const std::string& cause, const std::function<void(depth_frame_t&)>& spoil) {
    const uint64_t before = counters_.get("frames_refused_" + cause);
    send(pack(small_frame(++sequence_), 0.001, DepthEncoding::kRvl));
    depth_frame_t bad = pack(small_frame(++sequence_), 0.001, DepthEncoding::kRvl);
    spoil(bad);
    send(bad);
    EXPECT_EQ(counters_.get("frames_refused_" + cause), before + 1) << cause;
    mailbox_.put(DepthFrame{}, 0);  // so that take() never waits
    send(pack(small_frame(++sequence_), 0.001, DepthEncoding::kRvl));
    while (true) {
      const auto taken = mailbox_.take();
      ASSERT_TRUE(taken);
      if (taken->depth.sequence == sequence_) break;
    }
  }

  FrameMailbox mailbox_;
  Counters counters_;
  FrameIntake intake_{mailbox_, counters_, [] { return FrameOptions{}; }};
  int64_t sequence_ = 0;
};

TEST_F(Intake, ASoundFrameArrives) {
  send(pack(small_frame(7), 0.001, DepthEncoding::kRaw16));
  const auto taken = mailbox_.take();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->depth.sequence, 7);
  EXPECT_FLOAT_EQ(taken->depth.image.at(3, 3), 0.5f);
  EXPECT_LT(utime_now() - taken->receive_utime, 1'000'000);
}

/// Issue "The service", bad input: each is counted by its cause, and the next sound frame is taken.
TEST_F(Intake, EveryBadInputHasItsCounter) {
  expect_refused("unknown_encoding", [](auto& m) { m.encoding = 7; });
  expect_refused("wrong_size", [](auto& m) { m.width = 0; });
  expect_refused("wrong_size", [](auto& m) { m.encoding = depth_frame_t::RAW16; });
  expect_refused("too_many_pixels", [](auto& m) { m.width = 4096, m.height = 4096; });
  expect_refused("wrong_checksum", [](auto& m) { m.checksum ^= 1; });
  expect_refused("bad_intrinsics", [](auto& m) { m.fx = 0; });
  expect_refused("bad_depth_scale", [](auto& m) { m.depth_scale = -1; });
  expect_refused("bad_camera_name", [](auto& m) { m.camera = "a\nb"; });
  expect_refused("from_the_future", [](auto& m) { m.capture_utime += 10'000'000; });
  expect_refused("too_old", [](auto& m) { m.capture_utime -= 10'000'000; });
  expect_refused("sequence_went_back", [](auto& m) { m.sequence -= 1; });
  expect_refused("no_measurement", [](auto& m) {
    DepthFrame empty = small_frame(m.sequence);
    empty.image.depth.assign(1200, 0.f);
    m = pack(empty, 0.001, DepthEncoding::kRvl);
  });
  EXPECT_EQ(counters_.get("frames_lost"), 2u) << "what was refused is not also missing, but for the one "
                                                 "without a name and the one under another's number";
}

TEST_F(Intake, GarbageAndOtherChannelsAreCounted) {
  intake_.take(received(kDepthChannel, {}));
  intake_.take(received(kDepthChannel, std::vector<std::byte>(34, std::byte{0x7f})));
  intake_.take(received("ELSEWHERE", std::vector<std::byte>(10)));
  EXPECT_EQ(counters_.get("frames_refused_malformed"), 2u);
  EXPECT_EQ(counters_.get("messages_of_other_channels"), 1u);
}

TEST_F(Intake, GapsAreCountedAndTold) {
  send(pack(small_frame(1), 0.001, DepthEncoding::kRvl));
  mailbox_.take();
  send(pack(small_frame(5), 0.001, DepthEncoding::kRvl));
  EXPECT_EQ(counters_.get("frames_lost"), 3u);
  EXPECT_EQ(mailbox_.take()->dropped, (std::map<std::string, int64_t>{{"lost", 3}}));
}

}  // namespace
}  // namespace edgepose
