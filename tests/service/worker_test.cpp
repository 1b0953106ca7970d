#include "server/worker.h"

#include <gtest/gtest.h>

#include "daemon/clock.h"
#include "tests/messaging/network_namespace.h"
#include "tests/service/daemon.h"
#include "tests/service/moving_scene.h"

namespace edgepose {
namespace {

using test::eventually;

/// A worker without models: what happens to frames and commands, whatever is in them.
class WorkerTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network()) GTEST_SKIP() << "needs root or user namespaces, and ip (iproute2)";
    registry_ = std::make_unique<Registry>(folder_ / "");
    publisher_ = std::make_unique<AnswerPublisher>(parse_udpm_url(kDefaultLcmUrl), std::nullopt);
    worker_ = std::make_unique<Worker>(mailbox_, *registry_, options_, *publisher_, statistics_);
  }
  /// `age`: [s] since it was taken.
  static DepthFrame frame(int64_t sequence, double age) {
    static const DepthFrame first = test::moving_phantom(1)[0].depth;
    DepthFrame copy = first;
    copy.sequence = sequence;
    copy.capture_utime = utime_now() - static_cast<int64_t>(1e6 * age);
    return copy;
  }
  bool counts(const std::string& name, uint64_t count) {
    return eventually([&] { return statistics_.counters.get(name) >= count; });
  }

  test::Folder folder_;
  FrameMailbox mailbox_;
  LiveOptions options_{ServiceOptions{}};
  Statistics statistics_;
  std::unique_ptr<Registry> registry_;
  std::unique_ptr<AnswerPublisher> publisher_;
  std::unique_ptr<Worker> worker_;
};

TEST_F(WorkerTest, WhatGrewOldWhileItWaitedIsNotAnswered) {
  mailbox_.put(frame(1, 5), utime_now());
  EXPECT_TRUE(counts("frames_refused_too_old", 1));
  mailbox_.put(frame(2, 0), utime_now());
  EXPECT_TRUE(counts("frames_answered", 1));
  EXPECT_EQ(statistics_.last_frame()->sequence, 2);
}

TEST_F(WorkerTest, OneCommandBetweenTwoFrames) {
  std::atomic<int> jobs = 0;
  std::vector<int> before_frame;  // commands done when a frame had been answered
  for (int i = 0; i < 8; ++i)
    ASSERT_TRUE(worker_->post([&](const DepthFrame*) {
      before_frame.push_back(static_cast<int>(statistics_.counters.get("frames_answered")));
      mailbox_.put(frame(++jobs, 0), utime_now());
    }));
  ASSERT_TRUE(counts("frames_answered", 8));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(before_frame[static_cast<size_t>(i)], i);
}

TEST_F(WorkerTest, SoManyCommandsWaitAndNoMore) {
  std::atomic<bool> started = false, go_on = false;
  ASSERT_TRUE(worker_->post([&](const DepthFrame*) {
    started = true;
    eventually([&] { return go_on.load(); });
  }));
  ASSERT_TRUE(eventually([&] { return started.load(); }));
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(worker_->post([](const DepthFrame*) {}));
  EXPECT_FALSE(worker_->post([](const DepthFrame*) {}));
  EXPECT_GT(worker_->stuck_for(), 0);
  go_on = true;
  EXPECT_TRUE(eventually([&] { return worker_->post([](const DepthFrame*) {}); }));
}

}  // namespace
}  // namespace edgepose
