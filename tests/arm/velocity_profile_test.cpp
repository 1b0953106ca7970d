#include "arm/velocity_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/arm/arm_draws.h"

namespace edgepose {
namespace {

constexpr double kAcceleration = 5, kJerk = 50;

AxisMotion random_axis(ArmDraws& draws) {
  return {draws.between(-3, 3), draws.between(-3, 3), draws.between(-kAcceleration, kAcceleration)};
}

TEST(VelocityProfile, EndsAtItsTarget) {
  ArmDraws draws(1);
  for (int i = 0; i < 20000; ++i) {
    const AxisMotion from = random_axis(draws);
    const double target = draws.between(-3, 3);
    const VelocityProfile profile = velocity_profile(from, target, kAcceleration, kJerk);
    const double end = profile.duration();
    const AxisMotion just_before = profile.after(from, end * (1 - 1e-12));
    EXPECT_NEAR(just_before.velocity, target, 1e-9);
    EXPECT_NEAR(just_before.acceleration, 0, 1e-6);
    const AxisMotion later = profile.after(from, end + 1);
    EXPECT_EQ(later.velocity, target);
    EXPECT_EQ(later.acceleration, 0);
    EXPECT_NEAR(later.position, just_before.position + target, 1e-8);
  }
}

TEST(VelocityProfile, KeepsItsLimitsOnTheWay) {
  ArmDraws draws(2);
  for (int i = 0; i < 2000; ++i) {
    const AxisMotion from = random_axis(draws);
    const VelocityProfile profile = velocity_profile(from, draws.between(-3, 3), kAcceleration, kJerk);
    AxisMotion last = from;
    const double step = profile.duration() / 100 + 1e-6;
    for (int k = 1; k <= 101; ++k) {
      const AxisMotion state = profile.after(from, k * step);
      EXPECT_LE(std::abs(state.acceleration), kAcceleration + 1e-9);
      EXPECT_LE(std::abs(state.acceleration - last.acceleration), kJerk * step + 1e-6);
      last = state;
    }
  }
}

TEST(VelocityProfile, NoProfileWithinTheLimitsIsFaster) {
  // From rest: the textbook's times, with and without reaching the largest acceleration.
  EXPECT_NEAR(velocity_profile({}, 0.1, kAcceleration, kJerk).duration(), 2 * std::sqrt(0.1 / kJerk), 1e-12);
  EXPECT_NEAR(velocity_profile({}, 2, kAcceleration, kJerk).duration(),
              2 / kAcceleration + kAcceleration / kJerk, 1e-12);
  // Braking already as hard as allowed, the rest of it: nothing is gained or lost by looking again.
  ArmDraws draws(3);
  for (int i = 0; i < 5000; ++i) {
    const AxisMotion from = random_axis(draws);
    const VelocityProfile whole = velocity_profile(from, 0, kAcceleration, kJerk);
    const double part = draws.between(0, whole.duration());
    const VelocityProfile rest = velocity_profile(whole.after(from, part), 0, kAcceleration, kJerk);
    EXPECT_NEAR(rest.duration(), whole.duration() - part, 1e-6);
  }
}

TEST(VelocityProfile, ExtentHoldsWhatIsPassed) {
  ArmDraws draws(4);
  for (int i = 0; i < 2000; ++i) {
    const AxisMotion from = random_axis(draws);
    const VelocityProfile profile = velocity_profile(from, draws.between(-3, 3), kAcceleration, kJerk);
    const MotionExtent passed = extent(from, profile);
    double lowest = from.position, highest = from.position, speed = std::abs(from.velocity);
    for (int k = 0; k <= 1000; ++k) {
      const AxisMotion s = profile.after(from, profile.duration() * k / 1000);
      lowest = std::min(lowest, s.position);
      highest = std::max(highest, s.position);
      speed = std::max(speed, std::abs(s.velocity));
    }
    EXPECT_NEAR(passed.lowest, lowest, 1e-4);
    EXPECT_NEAR(passed.highest, highest, 1e-4);
    EXPECT_NEAR(passed.speed, speed, 1e-3);
    EXPECT_LE(passed.lowest, lowest + 1e-12);
    EXPECT_GE(passed.highest, highest - 1e-12);
  }
}

TEST(VelocityProfile, CanStopOnlyWhereThereIsRoom) {
  const AxisLimits limits{-1, 1, 3, kAcceleration, kJerk};
  // From 1 rad/s, not accelerating: 1 / A + A / J = 0.3 s at half the speed, 0.15 rad.
  EXPECT_TRUE(can_stop({0.8499, 1, 0}, limits));
  EXPECT_FALSE(can_stop({0.8501, 1, 0}, limits));
  EXPECT_TRUE(can_stop({-0.8499, -1, 0}, limits));
  EXPECT_FALSE(can_stop({-0.8501, -1, 0}, limits));
  EXPECT_TRUE(can_stop({-0.99, 1, 0}, limits));
  EXPECT_FALSE(can_stop({0, 2.9, 5}, limits)) << "still speeding up, beyond the largest velocity";
  EXPECT_FALSE(can_stop({0, 0, 5.1}, limits));
}

}  // namespace
}  // namespace edgepose
