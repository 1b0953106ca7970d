// No limit is broken, whatever is asked for: counted over random targets.
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "arm/inverse_velocity.h"
#include "arm/kinematics.h"
#include "arm/motion_limiter.h"
#include "arm/rigid_motion.h"
#include "tests/arm/arm_draws.h"

namespace edgepose {
namespace {

/// What was exceeded, counted per cycle; the slack is rounding, 10^-9 of each unit.
struct Broken {
  int position = 0, velocity = 0, acceleration = 0, jerk = 0, tip = 0, not_finite = 0;
  double fastest_tip = 0;
  int sum() const { return position + velocity + acceleration + jerk + tip + not_finite; }

  void count(const ArmGeometry& arm, const JointState& last, const JointState& next, const TipLimit& limit,
             const MotionOptions& options) {
    constexpr double kSlack = 1e-9;
    not_finite += !(next.position.allFinite() && next.velocity.allFinite() && next.acceleration.allFinite());
    position += (next.position.array() > arm.upper.array() - options.joint_margin + kSlack).any() ||
                (next.position.array() < arm.lower.array() + options.joint_margin - kSlack).any();
    // What is commanded are positions: their differences count too, not only what the states say of
    // themselves.
    const JointVector mean_velocity = (next.position - last.position) / options.cycle;
    velocity += (next.velocity.array().abs() > arm.max_velocity.array() + kSlack).any() ||
                (mean_velocity.array().abs() > arm.max_velocity.array() + kSlack).any();
    const JointVector mean_acceleration = (next.velocity - last.velocity) / options.cycle;
    acceleration += (next.acceleration.array().abs() > options.acceleration + kSlack).any() ||
                    (mean_acceleration.array().abs() > options.acceleration + kSlack).any();
    jerk +=
        ((next.acceleration - last.acceleration).array().abs() > options.jerk * options.cycle + kSlack).any();
    const double speed = point_velocity(arm, next.position, next.velocity, limit.flange_point).norm();
    fastest_tip = std::max(fastest_tip, speed);
    tip += speed > limit.speed + kSlack;
  }
};

JointVector inside(const ArmGeometry& arm, const MotionOptions& options, ArmDraws& draws) {
  const JointVector margin = JointVector::Constant(options.joint_margin);
  return draws.joints(arm.lower + margin, arm.upper - margin);
}

/// Targets are held for a while, mostly short, now and then long enough to reach full speed and the limits.
int cycles_held(ArmDraws& draws) {
  const double lot = draws.between(0, 1);
  return lot < 0.9    ? 1
         : lot < 0.99 ? static_cast<int>(draws.between(2, 20))
                      : static_cast<int>(draws.between(20, 300));
}

int targets(int by_default) { return std::getenv("EDGEPOSE_LONG_TESTS") ? 1000000 : by_default; }

TEST(Limits, NoneIsBrokenByAMillionRandomJointVelocities) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  const TipLimit none{Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()};
  ArmDraws draws(11);
  Broken broken;
  double fastest = 0;
  int64_t cycles = 0, at_limit = 0;
  JointState state{inside(arm, options, draws), JointVector::Zero(), JointVector::Zero()};
  for (int target = 0; target < 1000000; ++target) {
    if (target % 1000 == 0) state = {inside(arm, options, draws), JointVector::Zero(), JointVector::Zero()};
    const JointVector wanted = draws.joints(-2 * arm.max_velocity, 2 * arm.max_velocity);
    for (int i = cycles_held(draws); i > 0; --i, ++cycles) {
      const LimitedMotion motion = limit_motion(arm, state, wanted, none, options);
      broken.count(arm, state, motion.next, none, options);
      state = motion.next;
      fastest = std::max(fastest, (state.velocity.array() / arm.max_velocity.array()).abs().maxCoeff());
      at_limit += motion.bound == MotionBound::kJointLimit;
    }
  }
  std::cout << cycles << " cycles, " << at_limit << " held back by a joint limit, up to " << 100 * fastest
            << " % of the joints' velocities\n";
  EXPECT_EQ(broken.sum(), 0) << broken.position << ' ' << broken.velocity << ' ' << broken.acceleration << ' '
                             << broken.jerk << ' ' << broken.not_finite;
  EXPECT_GT(at_limit, 1000) << "the test must come to the limits";
  EXPECT_GT(fastest, 0.95);
}

/// Goals anywhere around the arm, in reach or not, approached by the whole chain: twist, inverse, limiter.
TEST(Limits, NoneIsBrokenByRandomGoalsOfTheTool) {
  const ArmGeometry arm = aubo_i5();
  const MotionOptions options;
  const InverseVelocityOptions inverse;
  ArmDraws draws(12);
  Broken broken;
  int64_t cycles = 0, held_by_joint = 0, held_by_tip = 0, near_singular = 0;
  JointState state{inside(arm, options, draws), JointVector::Zero(), JointVector::Zero()};
  TipLimit tip{drill_tip(), 0.05};
  for (int target = 0; target < targets(100000); ++target) {
    if (target % 100 == 0) {
      state = {inside(arm, options, draws), JointVector::Zero(), JointVector::Zero()};
      tip.speed = target % 200 == 0 ? 0.05 : 0.005;
    }
    const RigidTransform goal = rigid_transform(rotation_matrix(draws.vector(2)), draws.vector(1.2));
    for (int i = cycles_held(draws); i > 0; --i, ++cycles) {
      const RigidTransform flange = base_T_flange(arm, state.position);
      Twist twist;
      twist << goal.translation() - flange.translation(),
          rotation_vector(goal.linear() * flange.linear().transpose());
      const InverseVelocity wanted = inverse_velocity(arm, state.position, twist, inverse);
      near_singular += wanted.share < 1;
      const LimitedMotion motion = limit_motion(arm, state, wanted.velocity, tip, options);
      broken.count(arm, state, motion.next, tip, options);
      held_by_joint += motion.bound == MotionBound::kJointLimit;
      held_by_tip += motion.bound == MotionBound::kTipSpeed;
      state = motion.next;
    }
  }
  std::cout << cycles << " cycles, held back by a joint limit " << held_by_joint << ", by the tip's speed "
            << held_by_tip << ", near a singularity " << near_singular << ", fastest tip "
            << 1000 * broken.fastest_tip << " mm/s\n";
  EXPECT_EQ(broken.sum(), 0) << broken.position << ' ' << broken.velocity << ' ' << broken.acceleration << ' '
                             << broken.jerk << ' ' << broken.tip << ' ' << broken.not_finite;
  EXPECT_GT(broken.fastest_tip, 0.045) << "the test must come to the limits";
  EXPECT_GT(held_by_tip, 1000);
  EXPECT_GT(near_singular, 1000);
}

}  // namespace
}  // namespace edgepose
