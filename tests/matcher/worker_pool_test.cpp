#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "matcher/parallel.h"

namespace edgepose {
namespace {

TEST(ParallelFor, DoesEachPieceOnce) {
  for (int threads : {1, 2, 3, 8})
    for (size_t count : {0u, 1u, 2u, 7u, 1000u}) {
      std::vector<int> done(count, 0);
      parallel_for(count, threads, [&](size_t i) { ++done[i]; });
      EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), static_cast<int>(count));
      EXPECT_EQ(std::count(done.begin(), done.end(), 1), static_cast<long>(count));
    }
}

TEST(ParallelFor, ManyShortOnesFollowEachOther) {
  std::vector<long> sum(4, 0);
  for (int k = 0; k < 20000; ++k)
    parallel_for(sum.size(), 4, [&](size_t i) { sum[i] += static_cast<long>(i) + k % 3; });
  for (size_t i = 0; i < sum.size(); ++i)
    EXPECT_EQ(sum[i], 20000 * static_cast<long>(i) + 19999);  // k % 3 adds up to 6666 * 3 + 0 + 1
}

TEST(ParallelFor, WithinItselfAndFromSeveralThreadsAtOnce) {
  std::vector<std::vector<int>> done(3, std::vector<int>(50 * 20, 0));
  {
    std::vector<std::jthread> callers;
    for (auto& mine : done)
      callers.emplace_back([&mine] {
        for (int round = 0; round < 100; ++round)
          parallel_for(50, 3, [&](size_t i) { parallel_for(20, 2, [&](size_t j) { ++mine[i * 20 + j]; }); });
      });
  }
  for (const auto& mine : done)
    for (int count : mine) ASSERT_EQ(count, 100);
}

TEST(ParallelFor, TheFirstExceptionReachesTheCallerAndTheNextCallWorks) {
  EXPECT_THROW(parallel_for(100, 4,
                            [](size_t i) {
                              if (i == 17) throw std::runtime_error("seventeen");
                            }),
               std::runtime_error);
  std::vector<int> done(100, 0);
  parallel_for(100, 4, [&](size_t i) { ++done[i]; });
  EXPECT_EQ(std::count(done.begin(), done.end(), 1), 100);
}

}  // namespace
}  // namespace edgepose
