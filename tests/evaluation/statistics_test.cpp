#include "evaluation/statistics.h"

#include <gtest/gtest.h>

#include <limits>

namespace edgepose {
namespace {

TEST(Statistics, MedianOfOddAndEvenCounts) {
  EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(median({4, 1, 2, 3}), 2.5);
}

TEST(Statistics, PercentileInterpolatesAsNumpyDoes) {
  EXPECT_DOUBLE_EQ(percentile({1, 2, 3, 4, 5}, 0.95), 4.8);  // numpy.percentile([1, 2, 3, 4, 5], 95)
  EXPECT_DOUBLE_EQ(percentile({10, 20}, 0.25), 12.5);
  EXPECT_DOUBLE_EQ(percentile({5}, 0.95), 5);
  EXPECT_DOUBLE_EQ(percentile({1, 9}, 1), 9);
}

TEST(Statistics, NoValuesGiveZero) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(mean({}), 0);
  EXPECT_EQ(percentile({}, 0.5), 0);
}

TEST(Statistics, InfiniteValuesDoNotBecomeNan) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(median({1, infinity, infinity, infinity}), infinity);
}

}  // namespace
}  // namespace edgepose
