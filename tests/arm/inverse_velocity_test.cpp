#include "arm/inverse_velocity.h"

#include <gtest/gtest.h>

#include <limits>

#include "arm/kinematics.h"
#include "arm/motion_limiter.h"
#include "tests/arm/arm_draws.h"

namespace edgepose {
namespace {

const InverseVelocityOptions kOptions;
const TipLimit kTip{drill_tip(), 0.05};

Twist along(const Eigen::Vector3d& direction, double speed) {
  Twist twist = Twist::Zero();
  twist.head<3>() = direction.normalized() * speed;
  return twist;
}

TEST(InverseVelocity, IsExactFarFromSingularities) {
  const ArmGeometry arm = aubo_i5();
  ArmDraws draws(1);
  int seen = 0;
  for (int i = 0; i < 3000; ++i) {
    const JointVector position = draws.joints(arm.lower, arm.upper);
    const Jacobian jacobian = flange_jacobian(arm, position);
    Twist twist;
    twist << draws.vector(0.05), draws.vector(0.2);
    const InverseVelocity result = inverse_velocity(arm, position, twist, kOptions);
    EXPECT_NEAR(result.condition, condition_number(jacobian), 1e-6 * result.condition);
    if (result.condition > 10) continue;
    ++seen;
    EXPECT_EQ(result.share, 1);
    EXPECT_LT((jacobian * result.velocity - twist).norm(), 1e-9);
  }
  EXPECT_GT(seen, 100);
}

TEST(InverseVelocity, DampedWhereTheInverseIsNot) {
  const ArmGeometry arm = aubo_i5();
  JointVector position = bent();
  position[4] = 1e-9;  // the wrist is stretched: the inverse has an element of 10^9
  Twist twist;
  twist << 0.05, 0.05, 0.05, 0.2, 0.2, 0.2;
  const InverseVelocity result = inverse_velocity(arm, position, twist, kOptions);
  EXPECT_TRUE(result.velocity.allFinite());
  EXPECT_LT(result.velocity.norm(), 2);
  EXPECT_LE(result.share, kOptions.leaving_share);
}

/// Drives the flange along `direction` for `seconds`; returns the largest condition number on the way.
double drive(JointState& state, const Twist& twist, double seconds, double* least_share = nullptr) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  double worst = 0;
  for (double t = 0; t < seconds; t += options.cycle) {
    const InverseVelocity wanted = inverse_velocity(arm, state.position, twist, kOptions);
    if (least_share) *least_share = std::min(*least_share, wanted.share);
    state = limit_motion(arm, state, wanted.velocity, kTip, options).next;
    worst = std::max(worst, condition_number(flange_jacobian(arm, state.position)));
  }
  return worst;
}

TEST(InverseVelocity, GoalBeyondReachStopsBeforeTheSingularityAndTheArmComesBack) {
  JointState state{bent(), JointVector::Zero(), JointVector::Zero()};
  const ArmGeometry arm = aubo_i5();
  const RigidTransform start = base_T_flange(arm, state.position);
  const Eigen::Vector3d outwards = start.translation() - Eigen::Vector3d(0, 0, 0.122);
  double share = 1;
  const double worst = drive(state, along(outwards, 0.05), 60, &share);
  EXPECT_LT(worst, kOptions.stop_condition * 1.05);
  EXPECT_GT(worst, kOptions.slow_condition);
  EXPECT_LT(share, 0.2) << "it says that it is held back";
  EXPECT_LT(state.velocity.norm(), 0.02);
  const Eigen::Vector3d reached = base_T_flange(arm, state.position).translation();
  drive(state, along(-outwards, 0.05), 20);
  EXPECT_GT((base_T_flange(arm, state.position).translation() - reached).norm(), 0.1) << "it can leave";
}

TEST(InverseVelocity, LeavesASingularitySlowly) {
  JointState state{bent(), JointVector::Zero(), JointVector::Zero()};
  state.position[2] = 0.02;  // nearly stretched, condition beyond the stop
  const ArmGeometry arm = aubo_i5();
  ASSERT_GT(condition_number(flange_jacobian(arm, state.position)), 2 * kOptions.stop_condition);
  const Eigen::Vector3d inwards =
      Eigen::Vector3d(0, 0, 0.122) - base_T_flange(arm, state.position).translation();
  const MotionOptions options;
  bool left = false;
  for (int i = 0; i < 20000 && !left; ++i) {
    const InverseVelocity wanted = inverse_velocity(arm, state.position, along(inwards, 0.05), kOptions);
    if (wanted.condition > kOptions.stop_condition) {
      EXPECT_LE(wanted.share, kOptions.leaving_share);
    }
    state = limit_motion(arm, state, wanted.velocity, kTip, options).next;
    left = wanted.condition < kOptions.slow_condition;
  }
  EXPECT_TRUE(left);
}

TEST(InverseVelocityOptions, NameTheirFault) {
  EXPECT_EQ(kOptions.check(), "");
  InverseVelocityOptions options;
  options.stop_condition = 10;
  EXPECT_EQ(options.check().substr(0, 15), "stop_condition:");
}

}  // namespace
}  // namespace edgepose
