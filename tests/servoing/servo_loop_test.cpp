// The whole loop on an arm that follows its commands, with poses that are late as the service's are.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "arm/kinematics.h"
#include "common/error.h"
#include "servoing/servo.h"
#include "tests/servoing/rig.h"

namespace edgepose {
namespace {

constexpr double kCycle = 0.005, kFrame = 0.1, kDelay = 0.15;

JointVector bent() { return (JointVector() << 0.3, -0.4, 1.4, 0.2, 1.5, 0.1).finished(); }

/// Arm, camera and model; what the controller is told may differ from it.
struct Simulation {
  ArmGeometry arm = aubo_i5();
  ToldCalibration truth = true_rig();
  ServoOptions options;
  Servo servo;
  JointVector joints = bent();
  RigidTransform base_T_model;
  ServoGoal goal{{0.01, -0.01, -0.02}, Eigen::Vector3d(0.1, 0.2, 1).normalized()};
  double now = 10;
  int64_t frame = 0;
  std::optional<PoseReading> pending;
  double pending_due = 0;
  bool poses_on = true;
  std::function<void(PoseReading&)> tamper = [](PoseReading&) {};
  double fastest_tip = 0, fastest_axial = 0;
  std::array<int64_t, kPoseVerdicts> verdicts{};

  explicit Simulation(const ToldCalibration& told = true_rig(), const ServoOptions& servo_options = {})
      : options(servo_options), servo(arm, told, camera_T_tool(true_rig()), servo_options) {
    // The hole is some 8 cm and 15 degrees from where the tool is.
    const RigidTransform tool = base_T_flange(arm, joints) * truth.flange_T_tool;
    const RigidTransform hole = model_T_tool_goal(goal.entry, goal.axis, 0.0, RigidTransform::Identity());
    base_T_model =
        tool * rigid_transform(rotation_matrix({0.2, -0.15, 0.1}), {0.03, 0.02, 0.07}) * hole.inverse();
  }

  RigidTransform base_T_tool() const { return base_T_flange(arm, joints) * truth.flange_T_tool; }
  double tip_error() const { return (base_T_tool().translation() - base_T_model * goal.entry).norm(); }
  double axis_error() const {
    return std::acos(std::min(1.0, base_T_tool().linear().col(2).dot(base_T_model.linear() * goal.axis)));
  }

  const ServoSample& step() {
    std::optional<PoseReading> arrived;
    if (pending && now >= pending_due) arrived.swap(pending);
    if (poses_on && !pending && now >= 10 + static_cast<double>(frame) * kFrame) {
      PoseReading reading;
      reading.sequence = ++frame;
      reading.capture_time = now - kCycle;
      reading.accepted = true;
      reading.score = 0.9;
      reading.covariance = Eigen::Matrix<double, 6, 6>::Identity() * 1e-8;
      reading.camera_T_model = (base_T_flange(arm, joints) * truth.flange_T_camera).inverse() * base_T_model;
      tamper(reading);
      pending = reading;
      pending_due = now + kDelay;
    }
    const ServoSample& sample = servo.cycle(now, joints, arrived);
    if (sample.verdict) ++verdicts[static_cast<size_t>(*sample.verdict)];
    const double speed = point_velocity(arm, sample.command.position, sample.command.velocity,
                                        truth.flange_T_tool.translation())
                             .norm();
    fastest_tip = std::max(fastest_tip, speed);
    if (sample.state == ServoState::kAxial) fastest_axial = std::max(fastest_axial, speed);
    joints = sample.command.position;
    now += kCycle;
    return sample;
  }
  void run(double seconds) {
    for (const double end = now + seconds; now < end;) step();
  }
  bool run_until(ServoState state, double seconds) {
    for (const double end = now + seconds; now < end && servo.state() != state;) step();
    return servo.state() == state;
  }
  void arm_and_go() {
    EXPECT_EQ(servo.arm(joints), "");
    EXPECT_EQ(servo.go(goal, now), "");
  }
};

TEST(ServoLoop, ComesToTheStandoffThenAlongTheAxisToTheTouch) {
  Simulation sim;
  sim.run(0.5);
  sim.arm_and_go();
  ASSERT_TRUE(sim.run_until(ServoState::kAxial, 30)) << fault_name(sim.servo.fault());
  EXPECT_NEAR(sim.tip_error(), sim.options.approach.standoff, 0.0005);
  EXPECT_LT(sim.axis_error(), 0.004);
  double off_axis = 0, nearest = 1;
  while (sim.servo.state() == ServoState::kAxial && sim.now < 80) {
    sim.step();
    const Eigen::Vector3d left = sim.base_T_model * sim.goal.entry - sim.base_T_tool().translation();
    const Eigen::Vector3d axis = sim.base_T_model.linear() * sim.goal.axis;
    off_axis = std::max(off_axis, left.cross(axis).norm());
    nearest = std::min(nearest, left.dot(axis));
  }
  EXPECT_EQ(sim.servo.state(), ServoState::kConverged);
  EXPECT_LT(off_axis, 0.0005) << "along the axis only";
  EXPECT_GT(nearest, -0.0003) << "not beyond the entry";
  EXPECT_LT(sim.tip_error(), 0.0003);
  EXPECT_LT(sim.axis_error(), 0.0035);
  EXPECT_LE(sim.fastest_tip, 0.05);
  EXPECT_LE(sim.fastest_axial, 0.005 + 1e-9);
  const JointVector touched = sim.joints;
  sim.run(2);
  EXPECT_LT((sim.joints - touched).norm(), 1e-3) << "converged: at rest";
  EXPECT_EQ(sim.servo.go(sim.goal, sim.now), "go is refused while converged");
}

TEST(ServoLoop, ConvergesWithAWrongHandEyeWhereTheGoalIsRight) {
  ToldCalibration told = true_rig();
  told.flange_T_camera =
      told.flange_T_camera * rigid_transform(rotation_matrix({0.01, -0.012, 0.008}), {0.01, -0.01, 0.01});
  Simulation sim(told);
  sim.arm_and_go();
  ASSERT_TRUE(sim.run_until(ServoState::kConverged, 100)) << fault_name(sim.servo.fault());
  EXPECT_LT(sim.tip_error(), 0.0004);
  EXPECT_LT(sim.axis_error(), 0.004);
}

TEST(ServoLoop, NothingMovesBeforeArmAndGo) {
  Simulation sim;
  const JointVector start = sim.joints;
  sim.run(1);
  EXPECT_EQ(sim.servo.go(sim.goal, sim.now), "go is refused while idle");
  EXPECT_EQ(sim.servo.arm(sim.joints), "");
  sim.run(1);
  EXPECT_EQ(sim.joints, start);
  EXPECT_EQ(sim.servo.state(), ServoState::kArmed);
}

TEST(ServoLoop, StopComesToRestAndStays) {
  Simulation sim;
  sim.arm_and_go();
  sim.run(1.5);
  ASSERT_GT(sim.fastest_tip, 0.02) << "under way";
  EXPECT_EQ(sim.servo.reset(), "reset is refused while the arm comes to rest");
  EXPECT_EQ(sim.servo.stop(), "");
  sim.run(0.3);
  const JointVector rest = sim.joints;
  sim.run(1);
  EXPECT_EQ(sim.joints, rest);
  EXPECT_EQ(sim.servo.state(), ServoState::kStopped);
  EXPECT_EQ(sim.servo.arm(sim.joints), "arm is refused while stopped");
  EXPECT_EQ(sim.servo.reset(), "");
  sim.arm_and_go();
  EXPECT_TRUE(sim.run_until(ServoState::kConverged, 60));
}

TEST(ServoLoop, SlowsToRestWithoutPosesAndGoesOnWithThem) {
  Simulation sim;
  sim.arm_and_go();
  sim.run(1.2);
  sim.poses_on = false;
  sim.run(1.2);
  const JointVector rest = sim.joints;
  sim.run(0.5);
  EXPECT_EQ(sim.joints, rest);
  EXPECT_EQ(sim.servo.state(), ServoState::kApproaching);
  sim.poses_on = true;
  sim.frame = static_cast<int64_t>((sim.now - 10) / kFrame) + 1;
  EXPECT_TRUE(sim.run_until(ServoState::kConverged, 60));
}

TEST(ServoLoop, PosesLostForLongAreAFaultThatKeepsItsLastStates) {
  Simulation sim;
  sim.arm_and_go();
  sim.run(1.2);
  sim.poses_on = false;
  sim.run(6);
  EXPECT_EQ(sim.servo.state(), ServoState::kFault);
  EXPECT_EQ(sim.servo.fault(), FaultCause::kPosesLost);
  ASSERT_EQ(sim.servo.last_samples().size(), 50u);
  EXPECT_EQ(sim.servo.last_samples().back().state, ServoState::kApproaching);
  EXPECT_EQ(sim.servo.go(sim.goal, sim.now), "go is refused while fault");
  EXPECT_EQ(sim.servo.reset(), "");
  EXPECT_EQ(sim.servo.state(), ServoState::kIdle);
  EXPECT_EQ(sim.servo.fault(), FaultCause::kNone);
}

TEST(ServoLoop, TamperedPosesMoveNothing) {
  const std::vector<std::pair<PoseVerdict, std::function<void(PoseReading&)>>> attacks = {
      {PoseVerdict::kNotProper, [](PoseReading& r) { r.camera_T_model.linear() *= 1.1; }},
      {PoseVerdict::kStale, [](PoseReading& r) { r.capture_time -= 1; }},
      {PoseVerdict::kFromFuture, [](PoseReading& r) { r.capture_time += 1; }},
      {PoseVerdict::kLowScore, [](PoseReading& r) { r.score = 0.1; }},
  };
  for (const auto& [verdict, attack] : attacks) {
    Simulation sim;
    const JointVector start = sim.joints;
    sim.tamper = attack;
    sim.arm_and_go();
    sim.run(2);
    EXPECT_EQ(sim.joints, start) << verdict_name(verdict);
    EXPECT_GT(sim.servo.gate().count(verdict), 3) << verdict_name(verdict);
  }
}

TEST(ServoLoop, AJumpUnderWayIsNotFollowed) {
  Simulation sim;
  sim.arm_and_go();
  sim.run(1);
  sim.tamper = [](PoseReading& r) {
    if (r.sequence % 2 == 0) r.camera_T_model.translation().x() += 0.05;
  };
  EXPECT_TRUE(sim.run_until(ServoState::kConverged, 100));
  EXPECT_GT(sim.verdicts[static_cast<size_t>(PoseVerdict::kJumped)], 5);
  EXPECT_LT(sim.tip_error(), 0.0003);
}

TEST(ServoLoop, AFirstPoseThatIsWrongMovesNothing) {
  Simulation sim;
  const JointVector start = sim.joints;
  sim.tamper = [](PoseReading& r) {
    if (r.sequence <= 2) r.camera_T_model.translation().x() += 0.05;
  };
  sim.arm_and_go();
  sim.run(2);
  EXPECT_EQ(sim.joints, start) << "the others contradict it: nothing is believed";
  EXPECT_EQ(sim.verdicts[static_cast<size_t>(PoseVerdict::kTaken)], 1);
  EXPECT_GT(sim.verdicts[static_cast<size_t>(PoseVerdict::kJumped)], 5);
}

TEST(ServoLoop, GoalOutOfReachIsNamed) {
  Simulation sim;
  sim.base_T_model.translation() += Eigen::Vector3d(1.5, 0, 0);
  sim.arm_and_go();
  ASSERT_TRUE(sim.run_until(ServoState::kFault, 119));
  EXPECT_TRUE(sim.servo.fault() == FaultCause::kSingularity || sim.servo.fault() == FaultCause::kJointLimit)
      << fault_name(sim.servo.fault());
  EXPECT_LT(condition_number(flange_jacobian(sim.arm, sim.joints)), 33);
}

TEST(ServoLoop, GoalBeyondAJointsLimitIsNamed) {
  Simulation sim;
  sim.joints[0] = 2.8;  // 0.14 rad from the limit less its margin; the goal is 0.3 rad around the base
  const RigidTransform hole = model_T_tool_goal(sim.goal.entry, sim.goal.axis, 0, RigidTransform::Identity());
  sim.base_T_model = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * sim.base_T_tool() * hole.inverse();
  sim.arm_and_go();
  double farthest = 0;
  while (sim.servo.state() != ServoState::kFault && sim.now < 110)
    farthest = std::max(farthest, sim.step().command.position[0]);
  EXPECT_EQ(sim.servo.fault(), FaultCause::kJointLimit) << fault_name(sim.servo.fault());
  EXPECT_LE(farthest, 2.94 + 1e-9);
  EXPECT_GT(farthest, 2.9);
}

TEST(ServoLoop, ToolTurnedAwayIsNamed) {
  Simulation sim;
  sim.goal.axis = -sim.goal.axis;
  sim.base_T_model =
      sim.base_T_tool() *
      model_T_tool_goal(sim.goal.entry, -sim.goal.axis, 0, RigidTransform::Identity()).inverse();
  sim.arm_and_go();
  EXPECT_TRUE(sim.run_until(ServoState::kFault, 5));
  EXPECT_EQ(sim.servo.fault(), FaultCause::kHalfTurn);
}

TEST(ServoLoop, ArmThatDoesNotFollowIsAFault) {
  Simulation sim;
  sim.arm_and_go();
  sim.run(1);
  const JointVector stuck = sim.joints;
  for (int i = 0; i < 2000 && sim.servo.state() != ServoState::kFault; ++i) {
    sim.step();
    sim.joints = stuck;
  }
  EXPECT_EQ(sim.servo.fault(), FaultCause::kFollowing);
}

TEST(ServoLoop, MeasuredStatesThatAreNoNumbersAreAFault) {
  Simulation sim;
  sim.arm_and_go();
  sim.run(1);
  sim.joints[2] = std::nan("");
  const ServoSample sample = sim.step();
  EXPECT_EQ(sim.servo.fault(), FaultCause::kBadState);
  EXPECT_TRUE(sample.command.position.allFinite());
}

TEST(ServoLoop, FaultsFromOutsideLatchTheFirstCause) {
  Simulation sim;
  sim.arm_and_go();
  sim.run(1.5);
  sim.servo.fail(FaultCause::kDrive, "joint 3: error 0x8611");
  sim.servo.fail(FaultCause::kBus, "bus off");
  sim.run(1);
  EXPECT_EQ(sim.servo.fault(), FaultCause::kDrive);
  EXPECT_EQ(sim.servo.fault_detail(), "joint 3: error 0x8611");
  EXPECT_TRUE(sim.servo.cycle(sim.now, sim.joints, {}).command.velocity.isZero(0));
}

TEST(ServoLoop, ArmIsRefusedBeyondALimit) {
  Simulation sim;
  sim.joints[1] = 3.0;
  EXPECT_EQ(sim.servo.arm(sim.joints), "arm is refused: joint 2 is beyond its limit; move it back by hand");
}

TEST(ServoLoop, SameCallsGiveTheSameBits) {
  Simulation a, b;
  a.arm_and_go();
  b.arm_and_go();
  a.run(3);
  b.run(3);
  EXPECT_EQ(a.joints, b.joints);
}

TEST(ServoOptions, NameTheirFault) {
  EXPECT_EQ(ServoOptions().check(), "");
  ServoOptions options;
  options.approach.axial_speed = 1;
  EXPECT_EQ(options.check().substr(0, 21), "approach.axial_speed:");
  EXPECT_THROW(Servo(aubo_i5(), true_rig(), camera_T_tool(true_rig()), options), InputError);
}

}  // namespace
}  // namespace edgepose
