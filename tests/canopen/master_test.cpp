#include "canopen/master.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/canopen/arm_on_wire.h"

namespace edgepose {
namespace {

using testing::HasSubstr;

TEST(Master, SetsSixDrivesUpAndTheyAreAsItWants) {
  ArmOnWire arm;
  arm.set_up();
  for (const auto& drive : arm.drives) {
    const ObjectDictionary& objects = drive->objects();
    EXPECT_EQ(drive->nmt(), NmtState::kOperational);
    EXPECT_EQ(drive->state(), DriveState::kSwitchOnDisabled);
    EXPECT_EQ(objects.value(object::kAbortOption), 3);
    EXPECT_EQ(objects.value(object::kMode), 8);
    EXPECT_EQ(objects.value({0x60c2, 1}), 5);
    EXPECT_EQ(objects.value({0x60c2, 2}), -3);
    EXPECT_EQ(objects.value({0x1400, 5}), 22);
    EXPECT_EQ(objects.value({0x1400, 1}), 0x200 + drive->node());
    EXPECT_EQ(objects.value({0x1016, 1}), 127 << 16 | 60);
    EXPECT_EQ(objects.value({0x1017, 0}), 40);
    EXPECT_EQ(objects.value({0x1800, 2}), 1);
    EXPECT_EQ(objects.value({0x1801, 2}), 4);
  }
  EXPECT_TRUE(arm.master.state().all_fresh);
  EXPECT_LT(arm.cycles, 120) << "a set-up takes less than 0.6 s";
}

TEST(Master, EnablesHoldingEachAxisWhereItIs) {
  ArmOnWire arm;
  arm.set_up();
  arm.set_points.fill(2.0);  // ignored until enabled
  ASSERT_EQ(arm.master.enable(arm.now), EnableResult::kBegun);
  EXPECT_LE(arm.until(MasterPhase::kEnabled, 100), 8);
  for (int i = 0; i < kAxes; ++i) {
    const auto& drive = *arm.drives[static_cast<size_t>(i)];
    EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
    EXPECT_NEAR(drive.position(), 0.1 * i, 1e-5);
  }
}

TEST(Master, FollowsSetPoints) {
  ArmOnWire arm;
  arm.enable();
  const PerAxis<double> before = arm.set_points;
  arm.move(0.5, 200);
  arm.cycles_of(20);
  ASSERT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << arm.master.fault_text();
  for (size_t i = 0; i < kAxes; ++i) {
    EXPECT_NEAR(arm.drives[i]->position(), before[i] + 0.5, 1e-5);
    EXPECT_NEAR(arm.master.state().axes[i].position, arm.drives[i]->position(), 6.1e-6) << "one count";
  }
}

TEST(Master, TellsTheDrivesVelocity) {
  ArmOnWire arm;
  arm.enable();
  arm.move(0.5, 40);
  for (const AxisState& axis : arm.master.state().axes) EXPECT_NEAR(axis.velocity, 0.5, 0.01);
}

TEST(Master, DisablesAndEnablesAgain) {
  ArmOnWire arm;
  arm.enable();
  ASSERT_TRUE(arm.master.disable(arm.now));
  EXPECT_LE(arm.until(MasterPhase::kReady, 100), 4);
  for (const auto& drive : arm.drives) EXPECT_EQ(drive->state(), DriveState::kSwitchOnDisabled);
  ASSERT_EQ(arm.master.enable(arm.now), EnableResult::kBegun);
  EXPECT_LE(arm.until(MasterPhase::kEnabled, 100), 8);
}

TEST(Master, SyncEveryCycleAndOneStateEach) {
  ArmOnWire arm;
  arm.enable();
  const size_t from = arm.wire.trace.size();
  arm.cycles_of(100);
  EXPECT_EQ(arm.count(0x080, from), 100u);
  for (uint16_t node = 1; node <= 6; ++node) {
    EXPECT_EQ(arm.count(0x180 + node, from), 100u);
    EXPECT_EQ(arm.count(0x200 + node, from), 100u);
    EXPECT_EQ(arm.count(0x280 + node, from), 25u);
    EXPECT_NEAR(static_cast<double>(arm.count(0x700 + node, from)), 12.5, 1);
  }
  EXPECT_NEAR(static_cast<double>(arm.count(0x77f, from)), 25, 1);
}

TEST(Master, StopIsLatchedUntilResetAndEnable) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.master.stop(arm.now);
  EXPECT_EQ(arm.cycles_to_quick_stop(), 1);
  EXPECT_GT(arm.ms_to_rest(), 0);
  arm.cycles_of(200);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kFault);
  EXPECT_EQ(arm.master.fault_text(), "stop requested");
  EXPECT_EQ(arm.master.enable(arm.now), EnableResult::kNotReady);
  for (const auto& drive : arm.drives) EXPECT_EQ(drive->state(), DriveState::kQuickStopActive);
  ASSERT_TRUE(arm.master.reset(arm.now));
  arm.until(MasterPhase::kReady);
  arm.cycles_of(3);
  ASSERT_EQ(arm.master.enable(arm.now), EnableResult::kBegun) << arm.master.fault_text();
  arm.until(MasterPhase::kEnabled);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kEnabled) << arm.master.fault_text();
}

TEST(Master, KeepsTheLastFiftyCyclesOfAFault) {
  ArmOnWire arm;
  arm.enable_and_move();
  arm.drives[2]->provoke(Provocation::kEmergency);
  arm.move(0.5, 30);
  const auto cycles = arm.master.last_cycles();
  ASSERT_EQ(cycles.size(), 50u);
  EXPECT_EQ(cycles.back().time_ns, arm.master.fault().time_ns);
  EXPECT_EQ(cycles.back().controlword[0], 0x02);
  EXPECT_EQ(cycles[48].controlword[0], 0x0f);
  EXPECT_EQ(cycles[48].time_ns - cycles[0].time_ns, 48 * 5 * kMs);
  EXPECT_GT(cycles[48].position[0], cycles[40].position[0]);
}

TEST(Master, BadSetPointsMoveNothing) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), inf, -inf, 1e300, 3.05, 0.2}) {
    ArmOnWire arm;
    arm.enable();
    const double before = arm.drives[0]->position();
    arm.set_points[0] = bad;
    arm.cycles_of(50);
    EXPECT_EQ(arm.master.fault().kind, FaultKind::kBadSetPoint) << bad;
    EXPECT_EQ(arm.master.fault().node, 1);
    EXPECT_NEAR(arm.drives[0]->position(), before, 1e-5) << bad;
  }
}

TEST(Master, FiltersForAllThatTheDrivesSayAndNothingElse) {
  ArmOnWire arm;
  arm.enable();
  arm.drives[0]->provoke(Provocation::kEmergency);
  arm.cycles_of(10);
  std::set<uint16_t> said;
  for (const CanFrame& frame : arm.wire.trace) {
    const uint16_t function = cob_id::function_of(frame.id);
    const bool from_master = frame.id == 0 || frame.id == 0x080 || frame.id == 0x77f ||
                             function == cob_id::kRpdo1 || function == cob_id::kSdoRequest;
    if (!from_master) said.insert(frame.id);
  }
  for (uint16_t node = 1; node <= 6; ++node)
    said.insert(static_cast<uint16_t>(0x080 + node));  // only one had an emergency
  const auto ids = MasterOptions{}.received_ids();
  EXPECT_EQ(std::set<uint16_t>(ids.begin(), ids.end()), said);
}

TEST(Master, OptionsOutOfRangeAreNamed) {
  LoopWire wire;
  MasterOptions options;
  options.nodes[3] = 2;
  try {
    Master master(wire.port(), options);
    FAIL() << "taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("nodes: expected each number once, found 2"));
  }
}

}  // namespace
}  // namespace edgepose
