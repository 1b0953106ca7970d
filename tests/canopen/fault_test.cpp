#include "canopen/fault.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

#include "tests/canopen/arm_on_wire.h"

namespace edgepose {
namespace {

using testing::HasSubstr;

/// [ms] from full speed (0.5 rad/s at 15 rad/s^2: 34 ms) to rest after the controlword is on the bus, in
/// whole cycles.
constexpr int kStopMs = 50;

TEST(Fault, KilledMasterDrivesStopByThemselves) {
  ArmOnWire arm;
  arm.enable_and_move(3.0 / 2);
  const int64_t killed = arm.now;
  arm.master_lives = false;
  const auto stopping = [](const auto& drive) { return drive->state() == DriveState::kQuickStopActive; };
  while (!std::all_of(arm.drives.begin(), arm.drives.end(), stopping) && arm.now < killed + 1000 * kMs)
    arm.cycle();
  EXPECT_LE((arm.now - killed) / kMs, 30);
  EXPECT_GT(arm.ms_to_rest(), 0);
  EXPECT_LE((arm.now - killed) / kMs, 150);
  arm.cycles_of(200);
  for (const auto& drive : arm.drives) EXPECT_EQ(drive->state(), DriveState::kQuickStopActive) << "holds";
}

TEST(Fault, MasterStoppedFor200MsNoBurstAfterwards) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.master_lives = false;
  arm.cycles_of(40);
  const PerAxis<double> rest{arm.drives[0]->position(), arm.drives[1]->position(), arm.drives[2]->position(),
                             arm.drives[3]->position(), arm.drives[4]->position(), arm.drives[5]->position()};
  arm.master_lives = true;
  const size_t from = arm.wire.trace.size();
  arm.cycle();
  EXPECT_EQ(arm.count(0x201, from), 1u) << "one set point, not those that were missed";
  EXPECT_EQ(arm.count(0x080, from), 1u);
  arm.cycles_of(50);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kFault);
  for (size_t i = 0; i < kAxes; ++i) EXPECT_EQ(arm.drives[i]->position(), rest[i]);
}

/// Loses `count` SYNCs in motion.
void lose_syncs(ArmOnWire& arm, int count) {
  int lost = 0;
  arm.wire.drop = [&lost, count](const CanFrame& frame) { return is_sync(frame) && lost++ < count; };
  arm.move(0.5, 60);
  arm.wire.drop = nullptr;
}

TEST(Fault, OneAndThreeLostSyncsGoThrough) {
  for (const int count : {1, 3}) {
    ArmOnWire arm;
    arm.enable_and_move();
    lose_syncs(arm, count);
    EXPECT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << count << ": " << arm.master.fault_text();
    EXPECT_EQ(arm.master.state().axes[0].missed_ever, static_cast<uint64_t>(count));
    arm.cycles_of(20);
    EXPECT_NEAR(arm.drives[0]->position(), arm.set_points[0], 1e-5);
  }
}

TEST(Fault, TenLostSyncsStop) {
  ArmOnWire arm;
  arm.enable_and_move();
  lose_syncs(arm, 10);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kFault);
  for (const auto& drive : arm.drives) EXPECT_EQ(drive->velocity(), 0);
  // The drives' own watch over SYNC and the master's over TPDO1 are as patient as each other: either may be
  // first.
  EXPECT_THAT(arm.master.fault().kind, testing::AnyOf(FaultKind::kLostState, FaultKind::kEmergency));
}

TEST(Fault, LostStatesOfOneAxisStopAll) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[3]->provoke(Provocation::kNoTpdo);
  EXPECT_EQ(arm.cycles_to_quick_stop({1, 2, 3, 5, 6}), 6) << "five missed, each seen a cycle later";
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kLostState);
  EXPECT_EQ(arm.master.fault_text(), "node 4: state lost: no TPDO1 for 5 cycles");
  EXPECT_LE(arm.ms_to_rest(), kStopMs);
}

TEST(Fault, LostHeartbeatStopsAllWithin150Ms) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[1]->provoke(Provocation::kNoHeartbeat);
  const int64_t from = arm.now;
  EXPECT_LE(arm.cycles_to_quick_stop(), 21) << "100 ms after the last one";
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kHeartbeat);
  EXPECT_EQ(arm.master.fault().node, 2);
  EXPECT_LE(arm.ms_to_rest(), kStopMs);
  EXPECT_LE((arm.now - from) / kMs, 150);
}

TEST(Fault, DeadDriveStopsAllWithin150Ms) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[5]->provoke(Provocation::kDead);
  const int64_t from = arm.now;
  EXPECT_LE(arm.cycles_to_quick_stop({1, 2, 3, 4, 5}), 6);
  EXPECT_EQ(arm.master.fault().node, 6);
  EXPECT_LE(arm.ms_to_rest(), kStopMs);
  EXPECT_LE((arm.now - from) / kMs, 150);
}

TEST(Fault, EmergencyOfOneStopsAllWithinTwoCyclesAndIsNamed) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[2]->provoke(Provocation::kEmergency);
  const size_t from = arm.wire.trace.size();
  EXPECT_LE(arm.cycles_to_quick_stop({1, 2, 4, 5, 6}), 2);
  EXPECT_EQ(arm.count(0x083, from), 1u);
  EXPECT_EQ(arm.master.fault_text(), "node 3: EMCY: 0x4210 (excess temperature of the device)");
  EXPECT_LE(arm.ms_to_rest(), kStopMs);
  EXPECT_EQ(arm.drives[2]->state(), DriveState::kFault);
  arm.cycles_of(100);
  EXPECT_EQ(arm.drives[2]->state(), DriveState::kFault) << "nothing resets itself";
}

TEST(Fault, AFaultOfTheDriveIsResetOnTheWayToEnabled) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[2]->provoke(Provocation::kEmergency);
  arm.move(0.5, 30);
  ASSERT_TRUE(arm.master.reset(arm.now));
  arm.until(MasterPhase::kReady);
  arm.cycles_of(3);
  EXPECT_EQ(arm.drives[2]->state(), DriveState::kFault);
  ASSERT_EQ(arm.master.enable(arm.now), EnableResult::kBegun);
  const size_t from = arm.wire.trace.size();
  EXPECT_LE(arm.until(MasterPhase::kEnabled, 100), 20);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << arm.master.fault_text();
  EXPECT_TRUE(std::any_of(arm.wire.trace.begin() + static_cast<std::ptrdiff_t>(from), arm.wire.trace.end(),
                          [](const CanFrame& f) { return f.id == 0x203 && f.data[0] == 0x80; }));
}

TEST(Fault, DriveThatRebootsInMotionMustBeHomed) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[4]->provoke(Provocation::kReboot);
  EXPECT_LE(arm.cycles_to_quick_stop({1, 2, 3, 4, 6}), 2);
  EXPECT_EQ(arm.master.fault_text(), "node 5: drive rebooted; homing required");
  EXPECT_LE(arm.ms_to_rest(), kStopMs);
  ASSERT_TRUE(arm.master.reset(arm.now));
  arm.until(MasterPhase::kReady);
  arm.cycles_of(3);
  EXPECT_FALSE(arm.master.state().axes[4].homed);
  EXPECT_EQ(arm.master.enable(arm.now), EnableResult::kHomingRequired);
  arm.master.confirm_homed(4);
  EXPECT_EQ(arm.master.enable(arm.now), EnableResult::kBegun);
}

void reset_to_ready(ArmOnWire& arm) {
  ASSERT_TRUE(arm.master.reset(arm.now));
  arm.until(MasterPhase::kReady);
  arm.cycles_of(3);
}

void expect_homing_required(ArmOnWire& arm, const std::set<size_t>& axes) {
  reset_to_ready(arm);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kReady) << arm.master.fault_text();
  for (size_t i = 0; i < kAxes; ++i) EXPECT_EQ(arm.master.state().axes[i].homed, !axes.contains(i)) << i;
  EXPECT_EQ(arm.master.enable(arm.now), EnableResult::kHomingRequired);
}

TEST(Fault, DriveThatBootsBetweenCyclesMustBeHomed) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.master.stop(arm.now);
  arm.cycles_of(40);
  arm.master_lives = false;
  arm.drives[3]->provoke(Provocation::kReboot);
  arm.cycles_of(200);
  arm.master_lives = true;  // reset() finds it among what has come in between
  expect_homing_required(arm, {3});
}

TEST(Fault, DriveThatHasLostItsPositionUnheardMustBeHomed) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.wire.drop = [](const CanFrame&) { return true; };
  arm.cycles_of(40);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kFault);
  DriveOptions anew;  // its encoder counts from zero
  anew.node = 5;
  arm.drives[4] = std::make_unique<Drive>(arm.wire.port(), anew, arm.now);
  arm.cycles_of(400);
  arm.wire.drop = nullptr;
  expect_homing_required(arm, {4});
}

TEST(Fault, DrivesThatHaveBrakedUnheardNeedNoHoming) {
  ArmOnWire arm;
  arm.enable_and_move(2.0);
  arm.wire.drop = [](const CanFrame&) { return true; };
  arm.cycles_of(100);
  arm.wire.drop = nullptr;
  reset_to_ready(arm);
  EXPECT_EQ(arm.master.enable(arm.now), EnableResult::kBegun);
}

TEST(Fault, DriveThatBootsInTheSetUpMustBeHomed) {
  ArmOnWire arm;
  arm.set_up();
  ASSERT_TRUE(arm.master.set_up(arm.now));
  arm.cycles_of(30);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kSettingUp);
  arm.drives[1]->provoke(Provocation::kReboot);
  arm.until(MasterPhase::kFault);
  expect_homing_required(arm, {1});
}

TEST(Fault, AllDrivesThatLoseTheirSupplyInTheSetUpMustBeHomed) {
  ArmOnWire arm;
  arm.set_up();
  ASSERT_TRUE(arm.master.set_up(arm.now));
  arm.cycles_of(30);
  for (const auto& drive : arm.drives) drive->provoke(Provocation::kReboot);
  arm.until(MasterPhase::kFault);
  arm.cycles_of(200);
  expect_homing_required(arm, {0, 1, 2, 3, 4, 5});
}

TEST(Fault, DriveThatBootsAfterASetUpThatFailedMustBeHomed) {
  ArmOnWire arm;
  arm.set_up();
  ASSERT_TRUE(arm.master.set_up(arm.now));
  arm.wire.drop = [](const CanFrame& frame) { return frame.id == 0x582; };  // node 2 answers no SDO
  arm.until(MasterPhase::kFault);
  arm.wire.drop = nullptr;
  arm.cycles_of(20);
  arm.drives[5]->provoke(Provocation::kReboot);
  arm.cycles_of(200);
  expect_homing_required(arm, {5});
}

TEST(Fault, ASetUpThatFailedIsNoReasonToHome) {
  ArmOnWire arm;
  arm.set_up();
  ASSERT_TRUE(arm.master.set_up(arm.now));
  arm.master.stop(arm.now);  // before any has booted
  arm.cycles_of(200);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kFault);
  reset_to_ready(arm);
  EXPECT_EQ(arm.master.enable(arm.now), EnableResult::kBegun);
}

TEST(Fault, BusOffIsLatched) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.wire.tell(arm.master_port, BusEvent::kBusOff);
  arm.master_port.answer = SendResult::kDown;
  arm.move(0.5, 40);
  EXPECT_EQ(arm.master.fault_text(), "bus-off");
  for (const auto& drive : arm.drives) {
    EXPECT_EQ(drive->state(), DriveState::kQuickStopActive);
    EXPECT_EQ(drive->velocity(), 0);
  }
  arm.master_port.answer = SendResult::kSent;
  arm.wire.tell(arm.master_port, BusEvent::kRestarted);
  arm.cycles_of(100);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kBusOff) << "an operator must look";
}

TEST(Fault, BusDownStops) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.master_port.answer = SendResult::kDown;
  arm.move(0.5, 3);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kBusDown);
}

TEST(Fault, NoRoomThreeTimesStopsAndNothingStaleIsSent) {
  ArmOnWire arm;
  arm.enable_and_move();
  for (const int full : {1, 2}) {
    arm.master_port.answer = SendResult::kNoRoom;
    arm.move(0.5, full);
    arm.master_port.answer = SendResult::kSent;
    const size_t from = arm.wire.trace.size();
    arm.move(0.5, 1);
    EXPECT_EQ(arm.count(0x201, from), 1u) << "only the newest set point";
    arm.move(0.5, 5);
    ASSERT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << arm.master.fault_text();
  }
  arm.master_port.answer = SendResult::kNoRoom;
  arm.move(0.5, 3);
  EXPECT_EQ(arm.master.fault_text(), "no room on the bus: no frame was taken for 3 cycles");
  arm.master_port.answer = SendResult::kSent;
  EXPECT_EQ(arm.cycles_to_quick_stop(), 1);
}

TEST(Fault, NoRoomAgainAndAgainStops) {
  const auto cycles_with_room = [](ArmOnWire& arm, int with_room, int without, int rounds) {
    for (int i = 0; i < rounds; ++i) {
      arm.master_port.answer = SendResult::kNoRoom;
      arm.move(0.5, without);
      arm.master_port.answer = SendResult::kSent;
      arm.move(0.5, with_room);
    }
  };
  ArmOnWire arm;
  arm.enable_and_move();
  cycles_with_room(arm, 2, 1, 30);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << arm.master.fault_text();
  cycles_with_room(arm, 1, 2, 4);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kNoRoom);
}

TEST(Fault, AFullBusTakesNoHalfSetOfTargets) {
  ArmOnWire arm;
  arm.enable_and_move();
  // Full from the third drive's set point on.
  const size_t from = arm.wire.trace.size();
  arm.wire.drop = [&](const CanFrame& frame) {
    if (frame.id == 0x202) arm.master_port.answer = SendResult::kNoRoom;
    return false;
  };
  arm.move(0.5, 1);
  arm.wire.drop = nullptr;
  EXPECT_EQ(arm.count(0x201, from), 1u);
  EXPECT_EQ(arm.count(0x203, from), 0u);
  EXPECT_EQ(arm.count(0x080, from), 0u) << "without SYNC none takes effect";
}

TEST(Fault, NothingIsPutBehindSyncsThatStillWait) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.master_port.leave_unconfirmed(1);
  arm.move(0.5, 20);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << "one may: " << arm.master.fault_text();
  arm.master_port.leave_unconfirmed(2);
  const size_t from = arm.wire.trace.size();
  arm.move(0.5, 2);
  EXPECT_EQ(arm.count(0x201, from) + arm.count(0x080, from), 0u);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << arm.master.fault_text();
  arm.move(0.5, 1);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kNoRoom);
  EXPECT_EQ(arm.cycles_to_quick_stop(), 1) << "a stop is sent all the same";
}

TEST(Fault, SyncsThatWereLostAreNotWaitedForAfterReset) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.master_port.leave_unconfirmed(2);  // thrown away with the queue: they stay so
  arm.move(0.5, 3);
  ASSERT_EQ(arm.master.fault().kind, FaultKind::kNoRoom);
  arm.cycles_of(50);
  ASSERT_TRUE(arm.master.reset(arm.now));
  arm.until(MasterPhase::kReady);
  arm.cycles_of(20);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kReady) << arm.master.fault_text();
  arm.master_port.leave_unconfirmed(4);  // two more
  arm.cycles_of(3);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kNoRoom) << "new ones count";
}

TEST(Fault, FloodedBusStopsWithin100Ms) {
  ArmOnWire arm;
  arm.enable_and_move();
  LoopWire::Port& babbler = arm.wire.port();
  const int64_t from = arm.now;
  const auto babble = [&] {
    for (int i = 0; i < 600; ++i) babbler.send({.id = 0x001, .size = 8, .data = {}, .time_ns = arm.now});
  };
  int cycles = 0;
  for (; !arm.master.fault() && cycles < 50; ++cycles) babble(), arm.move(0.5, 1);
  EXPECT_LE(cycles, 4);
  while (arm.drives[0]->velocity() != 0 && arm.now - from < 1000 * kMs) babble(), arm.move(0.5, 1);
  EXPECT_LE((arm.now - from) / kMs, 100);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kFlooded);
}

TEST(Fault, FloodThatKeepsEverythingElseOffTheBusStops) {
  ArmOnWire arm;
  arm.enable_and_move();
  const int64_t from = arm.now;
  arm.wire.drop = [](const CanFrame&) { return true; };  // nothing but the flood wins arbitration
  arm.move(0.5, 20);
  EXPECT_EQ((arm.now - from) / kMs, 100);
  for (const auto& drive : arm.drives) EXPECT_EQ(drive->velocity(), 0);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kFault);
}

TEST(Fault, FrozenStateStopsWithinThreeCycles) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[0]->provoke(Provocation::kFrozenState);
  // The first repeated state is seen a cycle after it was frozen.
  EXPECT_LE(arm.cycles_to_quick_stop(), 1 + 3);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kStuck);
  EXPECT_EQ(arm.master.fault().node, 1);
}

TEST(Fault, BlockedAxisStopsWithinThreeCycles) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[0]->provoke(Provocation::kJam);
  EXPECT_LE(arm.cycles_to_quick_stop({2, 3, 4, 5, 6}), 2 + 3);
  EXPECT_EQ(arm.master.fault().node, 1);
}

TEST(Fault, FollowingErrorStopsWithinThreeCyclesOfTheWindow) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[1]->provoke(Provocation::kDrag);
  int beyond = 0;
  for (int i = 0; i < 200 && !arm.master.fault(); ++i) {
    arm.move(0.5, 1);
    const bool flagged = std::any_of(arm.wire.trace.end() - 30, arm.wire.trace.end(),
                                     [](const CanFrame& f) { return f.id == 0x182 && f.data[1] & 0x20; });
    beyond += flagged;
  }
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kFollowingError) << arm.master.fault_text();
  EXPECT_EQ(arm.master.fault().node, 2);
  EXPECT_LE(beyond, 3);
  EXPECT_LE(arm.ms_to_rest(), kStopMs);
}

TEST(Fault, DriveThatDoesNotObeyTheStopLosesItsPower) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[0]->provoke(Provocation::kIgnoresController);
  arm.master.stop(arm.now);
  arm.move(0.5, 10);
  EXPECT_EQ(arm.wire.trace.back().id & 0x780, 0x180);
  const auto last = std::find_if(arm.wire.trace.rbegin(), arm.wire.trace.rend(),
                                 [](const CanFrame& f) { return f.id == 0x201; });
  EXPECT_EQ(last->data[0], 0x00) << "disable voltage";
  const auto obeyed = std::find_if(arm.wire.trace.rbegin(), arm.wire.trace.rend(),
                                   [](const CanFrame& f) { return f.id == 0x202; });
  EXPECT_EQ(obeyed->data[0], 0x02);
}

TEST(Fault, StateThatIsNotReachedIsNamedWithItsStatusword) {
  ArmOnWire arm;
  arm.set_up();
  arm.drives[5]->provoke(Provocation::kIgnoresController);
  ASSERT_EQ(arm.master.enable(arm.now), EnableResult::kBegun);
  const int64_t from = arm.now;
  arm.until(MasterPhase::kFault, 300);
  EXPECT_NEAR(static_cast<double>((arm.now - from) / kMs), 505, 10);
  EXPECT_THAT(arm.master.fault_text(),
              HasSubstr("node 6: transition timed out: expected ready to switch on, found switch on disabled "
                        "(statusword 0x0650)"));
}

TEST(Fault, DriveThatLeavesOperationStopsAll) {
  ArmOnWire arm;
  arm.enable_and_move();
  // Somebody else tells node 2 to shut down.
  LoopWire::Port& other = arm.wire.port();
  other.send(target_frame(2, {.controlword = 0x06, .mode = 8, .position = 0}, arm.now));
  arm.wire.drop = [](const CanFrame& f) { return f.id == 0x202; };
  arm.move(0.5, 1);
  arm.wire.drop = nullptr;
  EXPECT_LE(arm.cycles_to_quick_stop({1, 3, 4, 5, 6}), 2);
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kUnexpectedState);
  EXPECT_THAT(arm.master.fault_text(),
              HasSubstr("node 2: unexpected state: expected operation enabled, found ready"));
}

TEST(Fault, SecondNodeOfANumberInOperationStops) {
  ArmOnWire arm;
  arm.enable_and_move();
  LoopWire::Port& other = arm.wire.port();
  for (int i = 0; i < 10 && !arm.master.fault(); ++i) {
    CanFrame twin{.id = 0x184, .size = 7, .data = {0x27, 0x16, 8}, .time_ns = arm.now};
    const auto own = arm.drives[3]->objects().value(object::kPosition);
    for (size_t b = 0; b < 4; ++b) twin.data[3 + b] = static_cast<uint8_t>(own >> 8 * b);
    other.send(twin);
    arm.move(0.5, 1);
  }
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kDuplicateNode);
  EXPECT_EQ(arm.master.fault().node, 4);
}

}  // namespace
}  // namespace edgepose
