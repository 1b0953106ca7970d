#include "daemon/keep_awake.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>

#include "tests/client/child.h"

namespace edgepose {
namespace {

/// Threads of this process that give way to all others.
int idle_threads() {
  int count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    if (sched_getscheduler(std::stoi(task.path().filename())) == SCHED_IDLE) ++count;
  return count;
}

TEST(KeepAwake, AThreadThatGivesWayOnEveryProcessor) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  {
    const KeepAwake awake;
    EXPECT_TRUE(test::eventually([&] { return idle_threads() == CPU_COUNT(&allowed); })) << idle_threads();
  }
  EXPECT_EQ(idle_threads(), 0);
}

}  // namespace
}  // namespace edgepose
