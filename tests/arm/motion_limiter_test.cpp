#include "arm/motion_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "arm/kinematics.h"
#include "tests/arm/arm_draws.h"

namespace edgepose {
namespace {

const TipLimit kNoTipLimit{Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()};

JointState resting(const JointVector& position) {
  return {position, JointVector::Zero(), JointVector::Zero()};
}

TEST(MotionLimiter, ReachesTheWantedVelocityExactly) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  JointVector wanted;
  wanted << 0.1, -0.2, 0.05, 0.3, 0, -0.1;
  JointState state = resting(bent());
  for (int i = 0; i < 60; ++i) {
    const LimitedMotion motion = limit_motion(arm, state, wanted, kNoTipLimit, options);
    EXPECT_EQ(motion.bound, MotionBound::kNone);
    state = motion.next;
  }
  EXPECT_EQ(state.velocity, wanted);
  EXPECT_TRUE(state.acceleration.isZero(0));
}

TEST(MotionLimiter, JointDrivenToItsLimitStopsThereAndSaysWhich) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  JointState state = resting(bent());
  LimitedMotion motion;
  for (int i = 0; i < 2000; ++i) {
    motion = limit_motion(arm, state, JointVector::Unit(3) * 2.6, kNoTipLimit, options);
    state = motion.next;
    ASSERT_LE(state.position[3], 2.94 + 1e-9);
  }
  EXPECT_EQ(motion.bound, MotionBound::kJointLimit);
  EXPECT_EQ(motion.joint, 3);
  EXPECT_NEAR(state.position[3], 2.94, 2e-3) << "the margin is not given away";
  EXPECT_LT(std::abs(state.velocity[3]), 1e-2);
  // And back it goes.
  motion = limit_motion(arm, state, JointVector::Unit(3) * -1, kNoTipLimit, options);
  for (int i = 0; i < 200; ++i)
    motion = limit_motion(arm, motion.next, JointVector::Unit(3) * -1, kNoTipLimit, options);
  EXPECT_EQ(motion.bound, MotionBound::kNone);
  EXPECT_LT(motion.next.position[3], 2.2);
}

TEST(MotionLimiter, TipSpeedIsUsedButNotExceeded) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  const TipLimit tip{drill_tip(), 0.05};
  JointState state = resting(bent());
  double fastest = 0;
  for (int i = 0; i < 400; ++i) {
    state = limit_motion(arm, state, JointVector::Unit(0) * 3, tip, options).next;
    fastest = std::max(fastest, point_velocity(arm, state.position, state.velocity, tip.flange_point).norm());
  }
  EXPECT_LE(fastest, 0.05);
  EXPECT_GT(fastest, 0.045);
}

TEST(MotionLimiter, StopsFromAnyStateWithinItsLimits) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  ArmDraws draws(7);
  for (int trial = 0; trial < 300; ++trial) {
    JointState state = resting(draws.joints(arm.lower * 0.9, arm.upper * 0.9));
    const JointVector wanted = draws.joints(-arm.max_velocity, arm.max_velocity);
    const int cycles = static_cast<int>(draws.between(1, 200));
    for (int i = 0; i < cycles; ++i) state = limit_motion(arm, state, wanted, kNoTipLimit, options).next;
    const double duration = stop_duration(state, options);
    EXPECT_LE(duration, 3.14 / options.acceleration + 3 * options.acceleration / options.jerk);
    for (double t = 0; t < duration; t += options.cycle) {
      const JointState next = stop_motion(state, options);
      const JointVector change = next.acceleration - state.acceleration;
      EXPECT_LE(change.cwiseAbs().maxCoeff(), options.jerk * options.cycle + 1e-9);
      EXPECT_LE(next.acceleration.cwiseAbs().maxCoeff(), options.acceleration + 1e-9);
      EXPECT_LE((next.position.array() - arm.upper.array()).maxCoeff(), -options.joint_margin + 1e-9);
      state = next;
    }
    EXPECT_TRUE(at_rest(stop_motion(state, options)));
  }
}

TEST(MotionLimiter, WantedVelocitiesThatAreNoNumbersStopTheArm) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  JointState state = resting(bent());
  for (int i = 0; i < 50; ++i)
    state = limit_motion(arm, state, JointVector::Constant(0.5), kNoTipLimit, options).next;
  for (int i = 0; i < 100; ++i)
    state = limit_motion(arm, state, JointVector::Constant(std::nan("")), kNoTipLimit, options).next;
  EXPECT_TRUE(state.position.allFinite());
  EXPECT_TRUE(at_rest(state));
}

TEST(MotionLimiter, SmallerTipLimitSlowsDownAtOnce) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  TipLimit tip{drill_tip(), 0.05};
  JointState state = resting(bent());
  for (int i = 0; i < 200; ++i) state = limit_motion(arm, state, JointVector::Unit(0), tip, options).next;
  tip.speed = 0.005;
  const int cycles = static_cast<int>(stop_duration(state, options) / options.cycle) + 2;
  for (int i = 0; i < cycles; ++i) state = limit_motion(arm, state, JointVector::Unit(0), tip, options).next;
  EXPECT_LE(point_velocity(arm, state.position, state.velocity, tip.flange_point).norm(), 0.005);
}

TEST(MotionOptions, NameTheirFault) {
  EXPECT_EQ(MotionOptions().check(), "");
  MotionOptions options;
  options.jerk = -1;
  EXPECT_EQ(options.check().substr(0, 5), "jerk:");
  options = {};
  options.cycle = std::nan("");
  EXPECT_EQ(options.check().substr(0, 6), "cycle:");
}

}  // namespace
}  // namespace edgepose
