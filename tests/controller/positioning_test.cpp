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

}  // namespace
}  // namespace edgepose::test
