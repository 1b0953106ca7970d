#include "controller/cycle_clock.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "bus/steady_clock.h"

namespace edgepose {
namespace {

constexpr int64_t kMs = 1'000'000;  // [ns]

TEST(CycleClock, OfManyThreadsOneWorksOnEachDeadlineAndNoneTwice) {
  CycleTimes times;
  CycleClock clock(kMs);
  clock.begin();
  std::vector<int64_t> deadlines;  // no lock: who works is alone
  const int64_t end = steady_ns() + 300 * kMs;
  const auto run = [&] {
    CycleClock::Sleeper sleeper(clock);
    while (steady_ns() < end) {
      const auto deadline = sleeper.wait();
      if (!deadline) continue;
      const int64_t now = steady_ns();
      EXPECT_GE(now, *deadline);
      deadlines.push_back(*deadline);
      times.add(now - *deadline, 0);
      clock.done(times);
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back(run);
  for (std::thread& thread : threads) thread.join();
  ASSERT_GT(deadlines.size(), 10u);
  for (size_t i = 1; i < deadlines.size(); ++i) {
    EXPECT_GT(deadlines[i], deadlines[i - 1]);
    EXPECT_EQ((deadlines[i] - deadlines[0]) % kMs, 0);
  }
  EXPECT_EQ(times.cycles(), deadlines.size() + times.missed());
  const auto periods = static_cast<uint64_t>((deadlines.back() - deadlines.front()) / kMs) + 1;
  EXPECT_GE(times.cycles(), periods) << "what was left out is counted";
}

TEST(CycleClock, WhatWasMissedIsLeftOut) {
  CycleTimes times;
  CycleClock clock(kMs);
  clock.begin();
  CycleClock::Sleeper sleeper(clock);
  const auto first = sleeper.wait();
  ASSERT_TRUE(first);
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  clock.done(times);
  const auto second = sleeper.wait();
  ASSERT_TRUE(second);
  EXPECT_GE(*second - *first, 10 * kMs);
  EXPECT_GE(times.missed(), 9u);
  clock.done(times);
}

TEST(CycleClock, AnotherGoesOnWhileOneIsHeldUpBetweenCycles) {
  CycleTimes times;
  CycleClock clock(kMs);
  clock.begin();
  CycleClock::Sleeper held(clock), awake(clock);
  ASSERT_TRUE(held.wait());
  clock.done(times);
  std::vector<int64_t> served;
  while (served.size() < 5)
    if (const auto deadline = awake.wait()) {
      served.push_back(*deadline);
      clock.done(times);
    }
  const auto late = held.wait();  // all that is over has been served
  EXPECT_TRUE(!late || *late > served.back());
  if (late) clock.done(times);
}

}  // namespace
}  // namespace edgepose
