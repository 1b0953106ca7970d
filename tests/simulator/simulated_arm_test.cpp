#include "simulator/simulated_arm.h"

#include <gtest/gtest.h>

#include "bus/loop_wire.h"
#include "canopen/master.h"
#include "common/error.h"

namespace edgepose {
namespace {

constexpr int64_t kMillisecond = 1'000'000;

/// A master and the simulated arm on one wire, in virtual time.
struct ArmRig {
  int64_t now = 1'000'000'000;
  LoopWire wire;
  LoopWire::Port& master_port = wire.port();
  LoopWire::Port& arm_port = wire.port();
  Master master{master_port, MasterOptions{}};
  SimulatedArm arm;
  PerAxis<double> set_points{};

  explicit ArmRig(const SimulatedArmOptions& options = at_start()) : arm(arm_port, options, now) {
    for (int i = 0; i < kJoints; ++i) set_points[static_cast<size_t>(i)] = options.start[i];
  }
  static SimulatedArmOptions at_start() {
    SimulatedArmOptions options;
    options.start << -0.3, 0.2, -1.9, -0.3, -1.7, 0.1;
    return options;
  }
  void cycle() {
    master.cycle(now, set_points);
    for (int i = 0; i < 5; ++i, now += kMillisecond) arm.step(now);
  }
  void until(MasterPhase phase) {
    for (int i = 0; i < 2000 && master.state().phase != phase && master.state().phase != MasterPhase::kFault;
         ++i)
      cycle();
  }
  void enable() {
    ASSERT_TRUE(master.set_up(now));
    until(MasterPhase::kReady);
    for (int i = 0; i < 3; ++i) cycle();
    ASSERT_EQ(master.enable(now), EnableResult::kBegun) << master.fault_text();
    until(MasterPhase::kEnabled);
    ASSERT_EQ(master.state().phase, MasterPhase::kEnabled) << master.fault_text();
    for (size_t i = 0; i < kAxes; ++i) set_points[i] = master.state().axes[i].position;
  }
  void move(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      for (double& point : set_points) point += 0.2 * 0.005;
      cycle();
    }
  }
};

TEST(SimulatedArm, StartsWhereItIsToldAndGoesWhereTheMasterSays) {
  ArmRig rig;
  EXPECT_EQ(rig.arm.position(), ArmRig::at_start().start);
  rig.enable();
  rig.move(200);
  for (int i = 0; i < kJoints; ++i) {
    EXPECT_NEAR(rig.arm.position()[i], ArmRig::at_start().start[i] + 0.2, 0.005) << i;
    EXPECT_NEAR(rig.arm.velocity()[i], 0.2, 0.02) << i;
    EXPECT_EQ(rig.arm.drive(i).state(), DriveState::kOperationEnabled);
  }
}

TEST(SimulatedArm, ThreeLostSyncsPassTenStop) {
  ArmRig rig;
  rig.enable();
  rig.move(20);
  rig.arm.drop_syncs(3);
  rig.move(20);
  EXPECT_EQ(rig.master.state().phase, MasterPhase::kEnabled) << rig.master.fault_text();
  rig.arm.drop_syncs(10);
  rig.move(40);
  EXPECT_EQ(rig.master.state().phase, MasterPhase::kFault);
  EXPECT_EQ(rig.arm.velocity(), JointVector::Zero());
}

TEST(SimulatedArm, AProvokedDriveStopsTheArm) {
  ArmRig rig;
  rig.enable();
  rig.move(20);
  rig.arm.provoke(2, Provocation::kEmergency);
  rig.move(60);
  EXPECT_EQ(rig.master.state().phase, MasterPhase::kFault);
  EXPECT_NE(rig.master.fault_text().find("node 3"), std::string::npos) << rig.master.fault_text();
  EXPECT_EQ(rig.arm.velocity(), JointVector::Zero());
}

TEST(SimulatedArm, WrongDuplicateAndAbsentDrivesAreFoundInTheSetUp) {
  SimulatedArmOptions foreign = ArmRig::at_start(), duplicate = foreign, absent = foreign;
  foreign.identities[1].vendor = 0x9a8b;
  duplicate.duplicate_axis = 3;
  absent.absent_axis = 4;
  for (const auto& [options, word] :
       {std::pair{foreign, "node 2"}, {duplicate, "node 4"}, {absent, "node 5"}}) {
    ArmRig rig(options);
    ASSERT_TRUE(rig.master.set_up(rig.now));
    rig.until(MasterPhase::kReady);
    EXPECT_EQ(rig.master.state().phase, MasterPhase::kFault) << word;
    EXPECT_NE(rig.master.fault_text().find(word), std::string::npos) << rig.master.fault_text();
  }
}

TEST(SimulatedArm, SaysWhenTheBusHasEnded) {
  ArmRig rig;
  EXPECT_FALSE(rig.arm.step(rig.now));
  rig.wire.tell(rig.arm_port, BusEvent::kDown);
  EXPECT_TRUE(rig.arm.step(rig.now));
}

TEST(SimulatedArm, NamesABadOption) {
  LoopWire wire;
  SimulatedArmOptions options;
  options.start[2] = std::nan("");
  EXPECT_THROW(SimulatedArm(wire.port(), options, 0), InputError);
  options = {};
  options.lag = 0;
  EXPECT_THROW(SimulatedArm(wire.port(), options, 0), InputError);
}

TEST(ProvocationNames, EachHasOne) {
  EXPECT_EQ(provocation_named("jam"), Provocation::kJam);
  EXPECT_EQ(provocation_named("dead"), Provocation::kDead);
  EXPECT_FALSE(provocation_named("hot"));
}

}  // namespace
}  // namespace edgepose
