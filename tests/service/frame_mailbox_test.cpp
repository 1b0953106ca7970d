#include "server/frame_mailbox.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>

namespace edgepose {
namespace {

DepthFrame frame(const std::string& camera, int64_t sequence) {
  DepthFrame f;
  f.camera = camera;
  f.sequence = sequence;
  return f;
}

TEST(FrameMailbox, TheNewestWinsAndTheRestIsCounted) {
  FrameMailbox mailbox;
  EXPECT_FALSE(mailbox.put(frame("a", 1), 10));
  EXPECT_TRUE(mailbox.put(frame("a", 2), 20));
  EXPECT_TRUE(mailbox.put(frame("a", 3), 30));
  mailbox.note_dropped("a", "lost", 4);
  const auto taken = mailbox.take();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->depth.sequence, 3);
  EXPECT_EQ(taken->receive_utime, 30);
  EXPECT_EQ(taken->dropped, (std::map<std::string, int64_t>{{"lost", 4}, {"superseded", 2}}));
  mailbox.put(frame("a", 4), 40);
  EXPECT_TRUE(mailbox.take()->dropped.empty()) << "told once";
}

TEST(FrameMailbox, CamerasTakeTurns) {
  FrameMailbox mailbox;
  mailbox.put(frame("a", 1), 0);
  mailbox.put(frame("b", 1), 0);
  mailbox.put(frame("a", 2), 0);  // newer, but it keeps its place
  EXPECT_EQ(mailbox.take()->depth.camera, "a");
  mailbox.put(frame("a", 3), 0);
  EXPECT_EQ(mailbox.take()->depth.camera, "b");
  EXPECT_EQ(mailbox.take()->depth.sequence, 3);
}

TEST(FrameMailbox, WakesWithoutAFrame) {
  FrameMailbox mailbox;
  std::thread other([&] { mailbox.wake(); });
  EXPECT_FALSE(mailbox.take());
  other.join();
}

/// Commands that come without end do not keep frames waiting.
TEST(FrameMailbox, AFrameComesBeforeBeingWoken) {
  FrameMailbox mailbox;
  mailbox.wake();
  mailbox.put(frame("a", 1), 0);
  EXPECT_TRUE(mailbox.take());
  EXPECT_FALSE(mailbox.take()) << "and it is woken all the same";
}

TEST(FrameMailbox, ManyCamerasStayBounded) {
  FrameMailbox mailbox;
  for (int i = 0; i < 1000; ++i) mailbox.note_dropped("camera" + std::to_string(i), "too_old", 1);
  EXPECT_LE(mailbox.cameras(), 64u);
}

/// Under load: every frame is either taken or counted as superseded.
TEST(FrameMailbox, NothingIsLostUncounted) {
  FrameMailbox mailbox;
  constexpr int kFrames = 20000;
  std::thread sender([&] {
    for (int i = 1; i <= kFrames; ++i) mailbox.put(frame("a", i), 0);
  });
  int64_t taken = 0, superseded = 0, last = 0;
  while (last < kFrames) {
    const auto next = mailbox.take();
    ASSERT_TRUE(next);
    EXPECT_GT(next->depth.sequence, last);
    last = next->depth.sequence;
    ++taken;
    for (const auto& [cause, count] : next->dropped) superseded += count;
  }
  sender.join();
  EXPECT_EQ(taken + superseded, kFrames);
}

}  // namespace
}  // namespace edgepose
