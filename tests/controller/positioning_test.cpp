#include <gmock/gmock.h>

#include "simulator/told.h"
#include "tests/controller/moving_arm.h"

namespace edgepose::test {
namespace {

TEST(Positioning, TouchesTheHoleWithExactCalibrations) {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    MovingArm arm(seed);
    ASSERT_EQ(arm->set_out(kTarget, 0), "");
    ASSERT_TRUE(arm->run_until([&] { return arm->controller.state() == ServoState::kConverged; }, 60))
        << state_name(arm->controller.state()) << " " << arm->controller.fault_text();
    const PositioningError error = arm->error(phantom_cell().find_target(kTarget));
    EXPECT_LT(error.translation, 0.0003);
    EXPECT_LT(error.angle, 0.2 * M_PI / 180);
  }
}

TEST(Positioning, TheSameCallsGiveTheSameBits) {
  MovingArm one(3), other(3);
  ASSERT_EQ(one->set_out(kTarget, 1), "");
  ASSERT_EQ(other->set_out(kTarget, 1), "");
  EXPECT_EQ(one->arm.position(), other->arm.position());
}

TEST(Positioning, NothingMovesWithoutArmAndGo) {
  MovingArm arm(1);
  EXPECT_EQ(arm.motion_during(1), 0);
  EXPECT_THAT(arm->go(kTarget), testing::HasSubstr("go is refused while idle"));
  EXPECT_EQ(arm->request({ArmCommand::kArm, {}}), "");
  // Two encoder steps: the drives hold the position that they have read.
  EXPECT_LT(arm.motion_during(1), 2 * 2 * M_PI / (1 << 20));
}

TEST(Positioning, StopComesToRestAndNeedsResetAndArm) {
  MovingArm arm(2);
  arm.set_out();
  arm->stop();
  EXPECT_GT(arm.ms_to_rest(), 0);
  arm->run(0.2);
  EXPECT_EQ(arm->controller.state(), ServoState::kStopped);
  EXPECT_NE(arm->go(kTarget), "");
  EXPECT_NE(arm->request({ArmCommand::kArm, {}}), "");
  EXPECT_EQ(arm->request({ArmCommand::kReset, {}}), "");
  EXPECT_EQ(arm->request({ArmCommand::kArm, {}}), "");
  arm->run(0.3);
  EXPECT_EQ(arm->go(kTarget), "");
  arm->run(0.3);
  EXPECT_TRUE(arm->is_moving());
}

TEST(Positioning, AnArmThatHangsBelowItsCommandIsCorrected) {
  VirtualCellOptions options;
  options.arm.sag << 0.003, -0.003, 0.002, 0.004, -0.002, 0.003;  // 3 mm and more at the tip
  MovingArm arm(1, options);
  ASSERT_EQ(arm->set_out(kTarget, 0), "");
  ASSERT_TRUE(arm->run_until([&] { return arm->controller.state() == ServoState::kConverged; }, 60))
      << state_name(arm->controller.state()) << " " << arm->controller.fault_text();
  EXPECT_LT(arm->error(phantom_cell().find_target(kTarget)).translation, 0.0003);
}

TEST(Positioning, GoNeedsPosesThatAreFresh) {
  MovingArm arm(1);
  ASSERT_EQ(arm->request({ArmCommand::kArm, {}}), "");
  arm->run(0.5);
  arm.source.set_wrong(PoseWrong::kJump50mm);  // the model has moved since
  arm->run(0.2);
  ASSERT_EQ(arm->go(kTarget), "");
  EXPECT_LT(arm.motion_during(3), 1e-5);
}

TEST(Positioning, ACameraThatWasStartedAgainIsListenedToAfterResetAndArm) {
  MovingArm arm(1);
  ASSERT_EQ(arm->request({ArmCommand::kArm, {}}), "");
  arm->run(0.5);
  ASSERT_EQ(arm->request({ArmCommand::kReset, {}}), "");
  PoseSource again(phantom_cell().plan, std::nullopt);  // counts from 1
  arm->feed = [&](const JointVector& joints, int64_t capture_utime) {
    return again.messages(camera_T_model(phantom_cell(), joints), capture_utime, capture_utime);
  };
  ASSERT_EQ(arm->set_out(kTarget, 1), "");
  EXPECT_TRUE(arm->is_moving());
}

TEST(Positioning, ResetIsRefusedWhileDrivesBrake) {
  MovingArm arm(3);
  arm.set_out();
  arm->arm.provoke(2, Provocation::kEmergency);
  arm->run(0.015);
  ASSERT_EQ(arm->controller.state(), ServoState::kFault);
  EXPECT_NE(arm->request({ArmCommand::kReset, {}}), "");
  arm->run(0.6);
  EXPECT_EQ(arm->request({ArmCommand::kReset, {}}), "");
}

}  // namespace
}  // namespace edgepose::test
