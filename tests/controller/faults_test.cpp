/// The faults of docs/servo_faults.md in simulated time, each tried with as many starts and moments as
/// repetitions() says. What is asserted is measured from the drives' truth and from the frames on the wire.
#include <gmock/gmock.h>

#include "canopen/cob_id.h"
#include "tests/controller/moving_arm.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;

template <class Trial>
void repeat(const Trial& trial) {
  for (uint64_t seed = 1; seed <= static_cast<uint64_t>(repetitions()); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    trial(seed);
    if (testing::Test::HasFatalFailure()) return;
  }
}

void expect_fault(MovingArm& arm, FaultCause cause, const std::string& text = "") {
  EXPECT_EQ(arm->controller.state(), ServoState::kFault);
  EXPECT_EQ(fault_name(arm->controller.servo().fault()), std::string(fault_name(cause)))
      << arm->controller.fault_text();
  EXPECT_THAT(arm->controller.fault_text(), HasSubstr(text));
}

/// After a fault nothing moves, whatever is said but reset and arm.
void expect_latched(MovingArm& arm) {
  arm->run(0.5);
  EXPECT_NE(arm->go(kTarget), "");
  EXPECT_NE(arm->request({ArmCommand::kArm, {}}), "");
  EXPECT_LT(arm.motion_during(0.3), 1e-5);
}

size_t frames_of(const LoopWire& wire, size_t from, uint16_t function) {
  size_t count = 0;
  for (size_t i = from; i < wire.trace.size(); ++i)
    if ((wire.trace[i].id & 0x780) == function) ++count;
  return count;
}

TEST(Faults, ControllerKilled) {
  Worst stopped("kill -9 of the controller: drives stop, ms"), rest("... at rest, ms");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm->controller_lives = false;
    const int to_stop = arm.ms_until([&] { return arm.all_stop(); });
    EXPECT_THAT(to_stop, testing::AllOf(testing::Ge(0), testing::Le(100)));
    const int to_rest = to_stop + std::max(0, arm.ms_to_rest());
    EXPECT_LE(to_rest, 300);
    stopped.add(to_stop), rest.add(to_rest);
  });
}

TEST(Faults, ControllerHeldFor200Milliseconds) {
  Worst most("controller held for 200 ms: frames of set points in the first 50 ms after it");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm->controller_lives = false;
    arm->run(0.2);
    EXPECT_FALSE(arm->is_moving());
    arm->controller_lives = true;
    const size_t from = arm->wire.trace.size();
    EXPECT_LT(arm.motion_during(0.05), 1e-5);
    const size_t burst = frames_of(arm->wire, from, cob_id::kRpdo1);
    EXPECT_LE(burst, 60u) << "six for each of the ten cycles";
    most.add(static_cast<double>(burst));
    EXPECT_EQ(arm->controller.state(), ServoState::kFault);
    expect_latched(arm);
  });
}

TEST(Faults, PoseServiceSilent) {
  Worst rest("pose service killed: at rest, ms after the last capture");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm.source.set_wrong(PoseWrong::kSilent);
    const int to_rest = arm.ms_to_rest();
    EXPECT_THAT(to_rest, testing::AllOf(testing::Ge(0), testing::Le(1000)));
    rest.add(to_rest);
    EXPECT_EQ(arm->controller.state(), ServoState::kApproaching);
    arm->run(5);
    expect_fault(arm, FaultCause::kPosesLost);
    expect_latched(arm);
  });
}

/// A wrong pose must have no effect at all: the same bits as if nothing had come.
struct WrongPoses : testing::TestWithParam<PoseWrong> {};
/// ... and those that are wrong by themselves, not as against the ones before.
struct WrongFirstPoses : testing::TestWithParam<PoseWrong> {};

/// Poses and messages that came and were refused.
uint64_t refused(MovingArm& arm) {
  uint64_t count = arm->sample.poses_refused;
  for (const char* name : {"messages_unsigned", "messages_altered", "messages_replayed", "poses_not_proper"})
    count += arm->poses.counters().get(name);
  return count;
}

TEST_P(WrongPoses, InMotionDoAsMuchAsSilence) {
  const SecretKey key = SecretKey::random();
  repeat([&](uint64_t seed) {
    MovingArm arm(seed, {}, key), twin(seed, {}, key);
    arm.set_out();
    twin.set_out();
    arm.source.set_wrong(GetParam());
    twin.source.set_wrong(PoseWrong::kSilent);
    const uint64_t before = refused(arm);
    arm->run(2.5);
    twin->run(2.5);
    EXPECT_GT(refused(arm), before + 30) << "they did come";
    EXPECT_EQ(arm->arm.position(), twin->arm.position());
    EXPECT_FALSE(arm->is_moving());
  });
}

/// A gate that took them would show: the test above can fail.
TEST(Faults, WithoutTheGateAJumpWouldHaveItsEffect) {
  VirtualCellOptions open;
  open.servo.gate.max_jump = 1;
  MovingArm arm(1, open), twin(1, open);
  arm.set_out();
  twin.set_out();
  arm.source.set_wrong(PoseWrong::kJump50mm);
  twin.source.set_wrong(PoseWrong::kSilent);
  arm->run(2.5);
  twin->run(2.5);
  EXPECT_GT((arm->arm.position() - twin->arm.position()).norm(), 0.01);
}

TEST_P(WrongFirstPoses, MoveNothing) {
  const SecretKey key = SecretKey::random();
  const DrillTarget& hole = phantom_cell().find_target(kTarget);
  repeat([&](uint64_t seed) {
    MovingArm arm(seed, {}, key);
    arm->run(0.2);  // good ones, so that there is something to say again
    arm.source.set_wrong(GetParam());
    arm->run(0.6);
    ASSERT_EQ(arm->request({ArmCommand::kArm, {}}), "");
    ASSERT_EQ(arm->request({ArmCommand::kGo, {hole.entry, hole.axis}}), "");
    const uint64_t before = refused(arm);
    EXPECT_LT(arm.motion_during(3), 2 * 2 * M_PI / (1 << 20));
    EXPECT_GT(refused(arm), before + 30) << "they did come";
  });
}

std::string name_of_wrong(const testing::TestParamInfo<PoseWrong>& one) {
  return "Wrong" + std::to_string(static_cast<int>(one.param));
}
INSTANTIATE_TEST_SUITE_P(All, WrongPoses,
                         testing::Values(PoseWrong::kOld, PoseWrong::kDuplicate, PoseWrong::kFuture,
                                         PoseWrong::kJump50mm, PoseWrong::kTurn20, PoseWrong::kTurn180,
                                         PoseWrong::kNan, PoseWrong::kNotOrthonormal,
                                         PoseWrong::kZeroQuaternion, PoseWrong::kUnsigned,
                                         PoseWrong::kAltered, PoseWrong::kReplayed),
                         name_of_wrong);
INSTANTIATE_TEST_SUITE_P(All, WrongFirstPoses,
                         testing::Values(PoseWrong::kOld, PoseWrong::kDuplicate, PoseWrong::kFuture,
                                         PoseWrong::kNan, PoseWrong::kNotOrthonormal,
                                         PoseWrong::kZeroQuaternion, PoseWrong::kUnsigned,
                                         PoseWrong::kAltered, PoseWrong::kReplayed),
                         name_of_wrong);

TEST(Faults, LostSyncs) {
  for (const int lost : {1, 3, 10}) {
    Worst fault(std::to_string(lost) + " lost SYNCs: times that it stopped");
    repeat([&](uint64_t seed) {
      MovingArm arm(seed);
      arm.set_out();
      int left = lost;
      arm->wire.drop = [&](const CanFrame& frame) { return frame.id == cob_id::kSync && left-- > 0; };
      arm->run(0.3);
      const bool stopped = arm->controller.state() == ServoState::kFault;
      EXPECT_EQ(stopped, lost == 10) << arm->controller.fault_text();
      fault.add(stopped);
      if (!stopped) return;
      EXPECT_FALSE(arm->is_moving());
      expect_latched(arm);
    });
  }
}

TEST(Faults, HeartbeatOfOneDriveLost) {
  Worst stopped("heartbeat of one drive lost: all stop, ms");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm->arm.provoke(static_cast<int>(seed % 6), Provocation::kNoHeartbeat);
    const int to_stop = arm.ms_until([&] { return arm.all_stop(); });
    EXPECT_THAT(to_stop, testing::AllOf(testing::Ge(0), testing::Le(150)));
    stopped.add(to_stop);
    expect_fault(arm, FaultCause::kDrive, "node " + std::to_string(seed % 6 + 1));
    expect_latched(arm);
  });
}

TEST(Faults, EmergencyOfOneAxis) {
  Worst stopped("EMCY of one axis: the others quick-stop, ms");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm->arm.provoke(static_cast<int>(seed % 6), Provocation::kEmergency);
    const int to_stop = arm.ms_until([&] { return arm.all_stop(); });
    EXPECT_THAT(to_stop, testing::AllOf(testing::Ge(0), testing::Le(10))) << "two cycles";
    stopped.add(to_stop);
    arm->run(0.1);
    expect_fault(arm, FaultCause::kDrive, "node " + std::to_string(seed % 6 + 1));
    EXPECT_THAT(arm->controller.fault_text(), HasSubstr("4210"));
    expect_latched(arm);
  });
}

TEST(Faults, DriveRebootsInMotion) {
  Worst rest("drive reboots in motion: at rest, ms");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm->arm.provoke(static_cast<int>(seed % 6), Provocation::kReboot);
    const int to_rest = arm.ms_to_rest();
    EXPECT_THAT(to_rest, testing::AllOf(testing::Ge(0), testing::Le(300)));
    rest.add(to_rest);
    expect_fault(arm, FaultCause::kDrive, "node " + std::to_string(seed % 6 + 1));
    arm->run(0.6);
    ASSERT_EQ(arm->request({ArmCommand::kReset, {}}), "");
    EXPECT_THAT(arm->request({ArmCommand::kArm, {}}), HasSubstr("homed"));
    EXPECT_EQ(arm->request({ArmCommand::kHomed, {}}), "");
    EXPECT_EQ(arm->request({ArmCommand::kArm, {}}), "");
  });
}

TEST(Faults, BusOff) {
  Worst rest("bus-off: at rest, ms");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm->wire.tell(arm->controller_port, BusEvent::kBusOff);
    arm->controller_port.answer = SendResult::kDown;
    const int to_rest = arm.ms_to_rest();
    EXPECT_THAT(to_rest, testing::AllOf(testing::Ge(0), testing::Le(300)));
    rest.add(to_rest);
    expect_fault(arm, FaultCause::kBus, "bus-off");
    arm->controller_port.answer = SendResult::kSent;
    expect_latched(arm);
  });
}

TEST(Faults, NoRoomOnTheBus) {
  Worst rest("ENOBUFS: at rest, ms");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    arm.set_out();
    arm->controller_port.answer = SendResult::kNoRoom;
    const int refused_before = arm->controller_port.refused;
    arm->run(0.005 * 3);
    EXPECT_EQ(arm->controller.state(), ServoState::kFault) << "after 3 cycles";
    EXPECT_GT(arm->controller_port.refused, refused_before);
    rest.add(15 + std::max(0, arm.ms_to_rest()));
    // The bus takes frames again: what could not be sent then is not sent now.
    arm->controller_port.answer = SendResult::kSent;
    const size_t from = arm->wire.trace.size();
    arm->run(0.05);
    for (size_t i = from; i < arm->wire.trace.size(); ++i)
      EXPECT_FALSE((arm->wire.trace[i].id & 0x780) == cob_id::kRpdo1 && arm->wire.trace[i].data[0] == 0x0f)
          << "a set point after the fault";
    expect_latched(arm);
  });
}

TEST(Faults, BusFlooded) {
  Worst rest("bus flooded: stop, ms");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    LoopWire::Port& babbler = arm->wire.port();
    arm.set_out();
    arm->each_ms = [&] {
      CanFrame frame;
      frame.id = 0x001;
      frame.size = 8;
      for (int i = 0; i < 300; ++i) babbler.send(frame);
    };
    int ms = 0;
    for (; ms < 500 && !arm.all_stop(); ms += 5) arm->cycle();
    EXPECT_LE(ms, 100);
    rest.add(ms);
    expect_fault(arm, FaultCause::kBus);
  });
}

TEST(Faults, DuplicateNodeIsNotEnabled) {
  repeat([&](uint64_t seed) {
    VirtualCellOptions options;
    options.arm.duplicate_axis = static_cast<int>(seed % 6);
    MovingArm arm(seed, options);
    EXPECT_THAT(arm->request({ArmCommand::kArm, {}}), HasSubstr("node " + std::to_string(seed % 6 + 1)));
    EXPECT_EQ(arm->controller.state(), ServoState::kFault);
    EXPECT_TRUE(arm.all_stop());
  });
}

TEST(Faults, WrongIdentityIsNotEnabled) {
  repeat([&](uint64_t seed) {
    VirtualCellOptions options;
    options.arm.identities[seed % 6].product = 0x9999;
    MovingArm arm(seed, options);
    const std::string answer = arm->request({ArmCommand::kArm, {}});
    EXPECT_THAT(answer, HasSubstr("node " + std::to_string(seed % 6 + 1)));
    EXPECT_THAT(answer, HasSubstr("0x9999"));
    EXPECT_TRUE(arm.all_stop());
  });
}

TEST(Faults, ANodeThatDoesNotAnswerIsNamed) {
  VirtualCellOptions options;
  options.arm.absent_axis = 3;
  MovingArm arm(1, options);
  const std::string answer = arm->request({ArmCommand::kArm, {}});
  EXPECT_THAT(answer, HasSubstr("node 4"));
  EXPECT_THAT(answer, HasSubstr("ms"));
}

TEST(Faults, FollowingError) {
  for (const Provocation kind : {Provocation::kJam, Provocation::kFrozenState}) {
    Worst stopped(kind == Provocation::kJam ? "axis jammed: cycles until the stop, beyond the drive's window"
                                            : "statusword stuck: cycles until the stop");
    repeat([&](uint64_t seed) {
      MovingArm arm(seed);
      arm.set_out();
      // The axis that moves most: one that stands may jam for good.
      int axis = 0;
      arm->arm.velocity().cwiseAbs().maxCoeff(&axis);
      arm->arm.provoke(axis, kind);
      const double window = kind == Provocation::kJam ? 0.05 : 0.002;
      const double begin = arm->sample.servo.command.position[axis];
      int cycles = 0, beyond = 0;
      for (; cycles < 600 && arm->controller.state() != ServoState::kFault; ++cycles) {
        arm->cycle();
        if (std::abs(arm->sample.servo.command.position[axis] - begin) > window) ++beyond;
      }
      EXPECT_EQ(arm->controller.state(), ServoState::kFault);
      EXPECT_LE(beyond, 3);
      stopped.add(beyond);
      arm->run(0.3);
      EXPECT_FALSE(arm->is_moving());
      expect_latched(arm);
    });
  }
}

/// Sends the arm to a goal and counts what exceeded the joints' limits. [rad/s] of the fastest joint.
double fastest_on_the_way(MovingArm& arm, const ServoGoal& goal) {
  EXPECT_EQ(arm->request({ArmCommand::kArm, {}}), "");
  arm->run(0.3);
  EXPECT_EQ(arm->request({ArmCommand::kGo, goal}), "");
  double fastest = 0;
  const ArmGeometry& geometry = phantom_cell().arm;
  arm->each_ms = [&] {
    fastest = std::max(fastest, arm->arm.velocity().cwiseAbs().maxCoeff());
    EXPECT_TRUE((arm->arm.position().array() <= geometry.upper.array()).all());
    EXPECT_TRUE((arm->arm.position().array() >= geometry.lower.array()).all());
  };
  const auto ended = [&] {
    return arm->controller.state() == ServoState::kFault || arm->controller.state() == ServoState::kConverged;
  };
  EXPECT_TRUE(arm->run_until(ended, 125)) << "it says so within goal_timeout";
  arm->run(0.5);
  EXPECT_FALSE(arm->is_moving());
  return fastest;
}

/// Through stretched arms, which are singular.
TEST(Faults, AGoalOutOfReachIsNamedAndNoLimitExceeded) {
  Worst velocity("goal out of reach: fastest joint, rad/s");
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    const double angle = 0.7 * static_cast<double>(seed);
    const Eigen::Vector3d far(1.6 * std::cos(angle), 1.6 * std::sin(angle), 0.2);  // base; 1.3 m is reached
    const ServoGoal goal{phantom_cell().base_T_model.inverse() * far,
                         phantom_cell().find_target(kTarget).axis};
    velocity.add(fastest_on_the_way(arm, goal));
    EXPECT_EQ(arm->controller.state(), ServoState::kFault);
    EXPECT_THAT(arm->controller.servo().fault(),
                testing::AnyOf(FaultCause::kSingularity, FaultCause::kJointLimit, FaultCause::kTimeout))
        << arm->controller.fault_text();
  });
}

/// Holes that point anywhere: many lie beyond a joint's limit.
TEST(Faults, AGoalBeyondAJointsLimitIsNamedAndNoLimitExceeded) {
  Worst velocity("goal of any direction: fastest joint, rad/s");
  int named = 0;
  repeat([&](uint64_t seed) {
    MovingArm arm(seed);
    const double s = static_cast<double>(seed);
    const Eigen::Vector3d axis =
        Eigen::Vector3d(std::cos(1.3 * s), std::sin(1.3 * s), std::sin(2.1 * s)).normalized();
    velocity.add(fastest_on_the_way(arm, {phantom_cell().find_target(kTarget).entry, axis}));
    if (arm->controller.state() != ServoState::kFault) return;
    ++named;
    EXPECT_THAT(arm->controller.servo().fault(),
                testing::AnyOf(FaultCause::kSingularity, FaultCause::kJointLimit, FaultCause::kHalfTurn,
                               FaultCause::kTimeout))
        << arm->controller.fault_text();
  });
  EXPECT_GT(named, 0);
}

TEST(Faults, StopWhileConvergedResumesOnlyAfterResetAndArm) {
  MovingArm arm(4);
  ASSERT_EQ(arm->set_out(kTarget, 0), "");
  ASSERT_TRUE(arm->run_until([&] { return arm->controller.state() == ServoState::kConverged; }, 60));
  arm->stop();
  arm->run(0.2);
  EXPECT_EQ(arm->controller.state(), ServoState::kStopped);
  EXPECT_NE(arm->go("right_pedicle_screw"), "");
  EXPECT_LT(arm.motion_during(1), 1e-5);
  EXPECT_EQ(arm->request({ArmCommand::kReset, {}}), "");
  EXPECT_NE(arm->go("right_pedicle_screw"), "");
  EXPECT_EQ(arm->request({ArmCommand::kArm, {}}), "");
  arm->run(0.3);
  EXPECT_EQ(arm->go("right_pedicle_screw"), "");
}

TEST(Faults, AClockSteppedByAnHourHasNoEffect) {
  for (const int64_t hours : {1, -1})
    repeat([&](uint64_t seed) {
      MovingArm arm(seed);
      arm.set_out();
      arm->wall_minus_steady_ns += hours * 3'600'000'000'000;
      arm->run(1);
      EXPECT_EQ(arm->controller.state(), ServoState::kApproaching) << arm->controller.fault_text();
      EXPECT_TRUE(arm->run_until([&] { return arm->controller.state() == ServoState::kConverged; }, 60));
      EXPECT_LT(arm->error(phantom_cell().find_target(kTarget)).translation, 0.0003);
    });
}

}  // namespace
}  // namespace edgepose::test
