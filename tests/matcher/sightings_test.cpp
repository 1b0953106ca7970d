#include "matcher/sightings.h"

#include <gtest/gtest.h>

namespace edgepose {
namespace {

TEST(ExpectedRounds, CountsWholeRoundsAsTheyAre) {
  for (int seen = 1; seen <= 8; ++seen) EXPECT_EQ(expected_rounds(seen, 8, 75, 600), seen);
  EXPECT_EQ(expected_rounds(12, 12, 75, 900), 12);
  EXPECT_EQ(expected_rounds(12, 12, 75, 3000), 12)
      << "no more than there were in what the scores were fitted to";
  EXPECT_EQ(expected_rounds(4, 8, 75, 900), 6) << "the last 300 references were not looked at";
}

TEST(ExpectedRounds, AnEarlyEndCostsAPoseThatEveryBatchSawLittle) {
  EXPECT_EQ(expected_rounds(19, 19, 32, 600), 8);
  EXPECT_GE(expected_rounds(2, 2, 32, 600), 7);
  EXPECT_EQ(expected_rounds(8, 8, 32, 256), 8) << "a small scene counts as one of 600 references";
}

TEST(ExpectedRounds, GrowsWithSightingsFallsWithBatchesAndStaysInRange) {
  for (const int batch : {1, 32, 75, 300, 1000})
    for (const size_t references : {1u, 50u, 600u, 900u})
      for (size_t looked = 1; looked <= 30; ++looked)
        for (int seen = 1; seen <= 40; ++seen) {  // more than batches, too: never beyond all rounds
          const int rounds = expected_rounds(seen, looked, batch, references);
          EXPECT_GE(rounds, 1);
          EXPECT_LE(rounds, references > 600 ? 12 : 8);
          EXPECT_LE(rounds, expected_rounds(seen + 1, looked, batch, references));
        }
}

}  // namespace
}  // namespace edgepose
