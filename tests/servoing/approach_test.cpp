#include "servoing/approach.h"

#include <gtest/gtest.h>

namespace edgepose {
namespace {

constexpr double kDegree = 0.017453292519943295;

TEST(Convergence, NeedsFiveInARow) {
  Convergence convergence{ApproachOptions()};
  const GoalError near{0.00029, 0.19 * kDegree};
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(convergence.add(near));
  EXPECT_FALSE(convergence.add({0.00031, 0})) << "one too far starts anew";
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(convergence.add(near));
  EXPECT_FALSE(convergence.add({0, 0.21 * kDegree}));
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(convergence.add(near));
  EXPECT_TRUE(convergence.add(near));
}

TEST(Approach, GoalMovesOnOnlyWhileTheToolFollowsAndEndsAtTheEntry) {
  const ApproachOptions options;
  EXPECT_EQ(next_standoff(0.04, {0.0011, 0}, 0.005, options), 0.04);
  EXPECT_EQ(next_standoff(0.04, {0, 0.6 * kDegree}, 0.005, options), 0.04);
  const double next = next_standoff(0.04, {0.0009, 0.4 * kDegree}, 0.005, options);
  EXPECT_LT(next, 0.04);
  EXPECT_GE(next, 0.04 - options.axial_speed * 0.005);
  EXPECT_EQ(next_standoff(1e-6, {}, 0.005, options), 0);
  EXPECT_EQ(next_standoff(0, {}, 0.005, options), 0);
}

TEST(Approach, OptionsNameTheirFault) {
  EXPECT_EQ(ApproachOptions().check(), "");
  ApproachOptions options;
  options.standoff = 0.06;
  EXPECT_EQ(options.check().substr(0, 18), "approach.standoff:");
}

}  // namespace
}  // namespace edgepose
