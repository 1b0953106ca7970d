#include "simulator/told.h"

#include <gtest/gtest.h>

#include "arm/rigid_motion.h"
#include "calibration/hand_eye_file.h"
#include "common/error.h"
#include "files/camera_file.h"
#include "tests/simulator/cell.h"
#include "tests/temporary_folder.h"

namespace edgepose {
namespace {

TEST(Told, WithoutNoiseItIsTheTruth) {
  const WorkCell cell = phantom_cell();
  const ToldEquipment told = draw_told(cell, ToldNoise::none(), 3);
  EXPECT_EQ(told.camera.fx, cell.camera.fx);
  EXPECT_TRUE(told.flange_T_camera.isApprox(cell.flange_T_camera, 1e-12));
  EXPECT_TRUE(told.flange_T_tool.isApprox(cell.flange_T_tool, 1e-12));
}

TEST(Told, DrawsOfOnePartDoNotDependOnTheOthers) {
  const WorkCell cell = phantom_cell();
  const ToldEquipment all = draw_told(cell, {}, 11);
  EXPECT_EQ(all.flange_T_tool.matrix(), draw_told(cell, {}, 11).flange_T_tool.matrix());
  ToldNoise only_tool = ToldNoise::none();
  only_tool.tool = ToldNoise{}.tool;
  EXPECT_EQ(all.flange_T_tool.matrix(), draw_told(cell, only_tool, 11).flange_T_tool.matrix());
  EXPECT_NE(all.flange_T_tool.matrix(), draw_told(cell, {}, 12).flange_T_tool.matrix());
}

TEST(Told, NoiseIsAsLargeAsItSays) {
  const WorkCell cell = phantom_cell();
  double focal = 0, centre = 0, shift = 0, turn = 0;
  constexpr int kDraws = 500;
  for (uint64_t seed = 1; seed <= kDraws; ++seed) {
    const ToldEquipment told = draw_told(cell, {}, seed);
    focal += std::pow(told.camera.fx - cell.camera.fx, 2);
    centre += std::pow(told.camera.cy - cell.camera.cy, 2);
    shift += (told.flange_T_camera.translation() - cell.flange_T_camera.translation()).squaredNorm() / 3;
    turn += (rotation_vector(told.flange_T_tool.linear()) - rotation_vector(cell.flange_T_tool.linear()))
                .squaredNorm() /
            3;
  }
  EXPECT_NEAR(std::sqrt(focal / kDraws), 5, 0.6);
  EXPECT_NEAR(std::sqrt(centre / kDraws), 1, 0.12);
  EXPECT_NEAR(std::sqrt(shift / kDraws), 0.01, 0.001);
  EXPECT_NEAR(std::sqrt(turn / kDraws), 0.01, 0.001);
}

TEST(Told, FilesSayWhatWasTold) {
  const TemporaryFolder folder;
  const ToldEquipment told = draw_told(phantom_cell(), {}, 4);
  write_told(folder / "told", told, "2026-11-23T09:30:00Z");
  const HandEyeFile hand_eye = read_hand_eye(folder / "told" / "hand-eye.json");
  EXPECT_TRUE(hand_eye.flange_T_camera.isApprox(told.flange_T_camera, 1e-12));
  EXPECT_EQ(hand_eye.method, "told by the simulator");
  EXPECT_TRUE(read_tool(folder / "told" / "tool.json").flange_T_tool.isApprox(told.flange_T_tool, 1e-12));
  EXPECT_EQ(read_camera((folder / "told" / "camera.json").string()).camera.fx, told.camera.fx);
}

TEST(Told, NamesANoiseThatIsNone) {
  ToldNoise noise;
  noise.tool = -1;
  EXPECT_THROW(draw_told(phantom_cell(), noise, 1), InputError);
  EXPECT_EQ(noise.check().substr(0, 5), "tool:");
}

}  // namespace
}  // namespace edgepose
