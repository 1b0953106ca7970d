#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "client/service/stop_signals.h"

namespace edgepose {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

TEST(Pacer, DelaysDoNotAddUp) {
  Pacer pacer(200);
  const auto start = steady_clock::now();
  for (int i = 0; i <= 40; ++i) {
    ASSERT_TRUE(pacer.wait({}));
    std::this_thread::sleep_for(2ms);  // the work between two frames
  }
  // With delays added, 40 periods of 5 ms would take 280 ms.
  EXPECT_GE(steady_clock::now() - start, 200ms);
  if (pacer.missed() == 0) {
    EXPECT_LT(steady_clock::now() - start, 250ms);
  }
}

TEST(Pacer, WhatIsMissedIsLeftOut) {
  Pacer pacer(100);
  ASSERT_TRUE(pacer.wait({}));
  std::this_thread::sleep_for(100ms);  // the stall that is tested
  ASSERT_TRUE(pacer.wait({}));
  EXPECT_GE(pacer.missed(), 8u);
  const auto before = steady_clock::now();
  ASSERT_TRUE(pacer.wait({}));
  ASSERT_TRUE(pacer.wait({}));
  EXPECT_GE(steady_clock::now() - before, 9ms) << "no burst";
}

TEST(StopSignals, OneAsksForAStopAndWaitsEnd) {
  const StopSignals signals;
  const std::stop_token stop = signals.token();
  EXPECT_FALSE(stop.stop_requested());
  std::jthread killer([] { kill(getpid(), SIGINT); });
  EXPECT_FALSE(wait_until(steady_clock::now() + 60s, stop));
  EXPECT_TRUE(stop.stop_requested());
}

TEST(StopSignals, TheSecondEndsTheProgram) {
  EXPECT_EXIT(
      {
        const StopSignals signals;
        kill(getpid(), SIGTERM);
        while (!signals.token().stop_requested()) std::this_thread::yield();
        kill(getpid(), SIGTERM);
        std::this_thread::sleep_for(60s);
      },
      testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace edgepose
