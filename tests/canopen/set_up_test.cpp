#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/canopen/arm_on_wire.h"

namespace edgepose {
namespace {

using testing::HasSubstr;

/// Runs a set-up that must fail; the text of the fault.
std::string failing_set_up(ArmOnWire& arm) {
  EXPECT_TRUE(arm.master.set_up(arm.now));
  arm.until(MasterPhase::kFault, 1000);
  EXPECT_EQ(arm.master.state().phase, MasterPhase::kFault);
  EXPECT_EQ(arm.master.enable(arm.now), EnableResult::kNotReady);
  arm.cycles_of(50);
  for (const auto& drive : arm.drives) EXPECT_EQ(drive->state(), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(arm.count(0x080), 0u) << "no SYNC, no motion";
  return arm.master.fault_text();
}

TEST(SetUp, NodeThatIsNotThere) {
  ArmOnWire arm;
  arm.drives.erase(arm.drives.begin() + 2);
  EXPECT_EQ(failing_set_up(arm), "node 3: expected boot-up after a reset, found none after 2000 ms");
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kSetUp);
}

TEST(SetUp, NodeThatDoesNotAnswer) {
  ArmOnWire arm;
  arm.drives[3]->provoke(Provocation::kNoSdo);
  EXPECT_EQ(failing_set_up(arm),
            "node 4: expected device profile (1000:00) to be 0x192, found no answer after 300 ms");
}

TEST(SetUp, WrongVendorAndProduct) {
  for (const auto& [vendor, product, text] :
       {std::tuple{0x9a8bu, 0x402u, "node 2: expected vendor (1018:01) to be 0xed9, found 0x9a8b after 5 ms"},
        std::tuple{0xed9u, 0x403u,
                   "node 2: expected product (1018:02) to be 0x402, found 0x403 after 5 ms"}}) {
    ArmOnWire arm;
    DriveOptions other;
    other.node = 2;
    other.identity.vendor = vendor;
    other.identity.product = product;
    arm.drives[1] = std::make_unique<Drive>(arm.wire.port(), other, arm.now);
    EXPECT_EQ(failing_set_up(arm), text);
  }
}

TEST(SetUp, WrongSerialNumberIfOneIsAskedFor) {
  MasterOptions options;
  options.serials[5] = 77;
  ArmOnWire arm(options);
  EXPECT_EQ(failing_set_up(arm), "node 6: expected serial number (1018:04) to be 0x4d, found 0x0 after 5 ms");
}

TEST(SetUp, TwoNodesOfOneNumber) {
  ArmOnWire arm;
  DriveOptions twin;
  twin.node = 5;
  arm.drives.push_back(std::make_unique<Drive>(arm.wire.port(), twin, arm.now));
  EXPECT_EQ(failing_set_up(arm),
            "node 5: expected one drive of this number, found two of them booted after 0 ms");
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kDuplicateNode);
}

TEST(SetUp, TwoNodesOfOneNumberOfWhichOneDoesNotBoot) {
  ArmOnWire arm;
  LoopWire::Port& twin = arm.wire.port();
  // Answers for node 5 as well, a little later than it.
  ASSERT_TRUE(arm.master.set_up(arm.now));
  for (int i = 0; i < 300 && !arm.master.fault(); ++i) {
    const size_t from = arm.wire.trace.size();
    arm.cycle();
    for (size_t k = from; k < arm.wire.trace.size(); ++k)
      if (arm.wire.trace[k].id == 0x585) {
        const CanFrame copy = arm.wire.trace[k];
        twin.send(copy);
        break;
      }
  }
  EXPECT_EQ(arm.master.fault().kind, FaultKind::kDuplicateNode);
  EXPECT_THAT(arm.master.fault_text(), HasSubstr("node 5: expected one drive of this number"));
}

TEST(SetUp, AnAbortIsToldInTheStandardsWords) {
  MasterOptions options;
  options.following_timeout = 0.010;
  ArmOnWire arm(options);
  // A drive whose answer to writing 6060 is an abort.
  LoopWire::Port& liar = arm.wire.port();
  bool lied = false;
  arm.wire.drop = [&](const CanFrame& frame) {
    if (frame.id != 0x601 || frame.data[1] != 0x60 || frame.data[2] != 0x60 || lied) return false;
    lied = true;
    const auto abort = sdo::abort({0x6060, 0}, SdoAbort::kInvalidValue);
    liar.send({.id = 0x581, .size = 8, .data = abort, .time_ns = frame.time_ns});
    return true;
  };
  EXPECT_EQ(
      failing_set_up(arm),
      "node 1: expected mode (6060:00) to take 0x8, found abort 0x6090030 (invalid value for the parameter) "
      "after 0 ms");
}

TEST(SetUp, GoesThroughFromEveryStateOfTheDrives) {
  ArmOnWire arm;
  arm.enable_and_move();
  // Another master takes over while the arm moves: the drives stop, and are set up again.
  LoopWire::Port& port = arm.wire.port();
  Master other(port, {});
  arm.master_lives = false;
  ASSERT_TRUE(other.set_up(arm.now));
  for (int i = 0; i < 200 && other.state().phase == MasterPhase::kSettingUp; ++i) {
    other.cycle(arm.now, arm.set_points);
    arm.cycle();
  }
  EXPECT_EQ(other.state().phase, MasterPhase::kReady) << other.fault_text();
  for (const auto& drive : arm.drives) EXPECT_EQ(drive->velocity(), 0);
}

TEST(SetUp, OneFrameLostIsOneTimeoutThatIsNamed) {
  ArmOnWire arm;
  bool lost = false;
  arm.wire.drop = [&](const CanFrame& frame) {
    const bool this_one = !lost && frame.id == 0x606 && frame.data[1] == 0x17;
    lost = lost || this_one;
    return this_one;
  };
  EXPECT_EQ(failing_set_up(arm),
            "node 6: expected heartbeat (1017:00) to take 0x28, found no answer after 300 ms");
}

TEST(SetUp, ABootUpOfBeforeIsNotASecondNode) {
  ArmOnWire arm;
  // The drives have been switched on a moment ago: their boot-up frames wait for whoever reads first.
  for (const auto& drive : arm.drives) drive->step(arm.now);
  arm.set_up();
}

}  // namespace
}  // namespace edgepose
