#include <gtest/gtest.h>

#include "arm/kinematics.h"
#include "arm/rigid_motion.h"
#include "common/error.h"
#include "simulator/random_draws.h"
#include "simulator/starts.h"
#include "tests/simulator/cell.h"

namespace edgepose {
namespace {

constexpr double kDegree = 0.017453292519943295;

TEST(WorkCell, NominalPostureTouchesTheTarget) {
  for (const char* name : {"left_pedicle_screw", "right_pedicle_screw", "spinous_process_pin"}) {
    const WorkCell cell = phantom_cell(name);
    const PositioningError error = positioning_error(cell, cell.nominal, cell.find_target(name));
    EXPECT_LT(error.translation, 1e-12) << name;
    EXPECT_LT(error.angle, 1e-9) << name;
  }
}

TEST(WorkCell, TipIsHalfAMetreFromTheCameraInTheMiddleOfItsImage) {
  const WorkCell cell = phantom_cell();
  const Eigen::Vector3d tip = (cell.flange_T_camera.inverse() * cell.flange_T_tool).translation();
  EXPECT_NEAR(tip.z(), 0.553, 0.001);
  EXPECT_NEAR(tip.head<2>().norm(), 0, 1e-9);
}

/// What the nominal posture was chosen for.
TEST(WorkCell, AllPosesWithin100MillimetresAnd20DegreesAreWellConditioned) {
  const WorkCell cell = phantom_cell();
  RandomDraws draws(5, DrawPurpose::kPose);
  for (const double standoff : {0.0, 0.04}) {
    const RigidTransform goal = cell.base_T_model * model_T_tool_at(cell.find_target(cell.target), standoff);
    for (int i = 0; i < 300; ++i) {
      const RigidTransform tool =
          goal * rigid_transform(rotation_matrix(20 * kDegree * draws.gauss(1).normalized()),
                                 0.1 * draws.gauss(1).normalized());
      const auto joints = joints_for(cell.arm, tool * cell.flange_T_tool.inverse(), cell.nominal);
      ASSERT_TRUE(joints) << i;
      EXPECT_LT(condition_number(flange_jacobian(cell.arm, *joints)), 13) << i;
      EXPECT_LT(joints->cwiseAbs().maxCoeff(), 2.7) << i;
      EXPECT_LT((*joints - cell.nominal).cwiseAbs().maxCoeff(), 1.2) << i;
    }
  }
}

TEST(WorkCell, ErrorIsTakenApartAlongAndAcrossTheAxis) {
  const WorkCell cell = phantom_cell();
  const DrillTarget& target = cell.find_target(cell.target);
  const RigidTransform off = rigid_transform(rotation_matrix({0.1, 0, 0}), {0.003, -0.004, 0.002});
  const PositioningError error = positioning_error(model_T_tool_at(target, 0.04) * off, target);
  EXPECT_NEAR(error.along, -0.038, 1e-12);
  EXPECT_NEAR(error.across, 0.005, 1e-12);
  EXPECT_NEAR(error.translation, std::hypot(0.038, 0.005), 1e-12);
  EXPECT_NEAR(error.angle, 0.1, 1e-12);
  const RigidTransform turned = rigid_transform(rotation_matrix({0, 0, 2}), Eigen::Vector3d::Zero());
  EXPECT_NEAR(positioning_error(model_T_tool_at(target, 0) * turned, target).angle, 0, 1e-9);
}

TEST(WorkCell, ClearanceIsThatOfTheDrillFromBoneAndTable) {
  const WorkCell cell = phantom_cell();
  EXPECT_LT(clearance(cell, base_T_tool(cell, cell.nominal)), 0.0015);  // touches
  RigidTransform beside = base_T_tool(cell, cell.nominal);
  beside.translation() = cell.base_T_table * Eigen::Vector3d(0.3, 0.3, 0.01);
  EXPECT_NEAR(clearance(cell, beside), 0.01, 0.001);
}

TEST(WorkCell, RefusesWhatDoesNotBelongTogether) {
  EXPECT_THROW(phantom_cell("no_such_hole"), InputError);
  WorkCell cell = phantom_cell();
  EXPECT_THROW(cell.find_target(""), InputError);
  EXPECT_THROW(make_work_cell(WorkCellOptions{}), InputError);
  cell.model.triangles.clear();
  EXPECT_THROW(make_work_cell(cell.model, cell.plan, ""), InputError);
}

}  // namespace
}  // namespace edgepose
