#include "simulator/cell_camera.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "simulator/starts.h"
#include "simulator/told.h"
#include "tests/simulator/cell.h"

namespace edgepose {
namespace {

/// Each point that the image shows of the bone, carried back by the true pose, is on the bone.
TEST(CellCamera, SeesTheModelWhereTheTruthSays) {
  const WorkCell cell = phantom_cell();
  CellCamera camera(cell, cell.camera);
  for (const JointVector& joints :
       {cell.nominal, draw_start(cell, cell.plan.targets[0], 3), draw_start(cell, cell.plan.targets[0], 4)}) {
    const RenderedView view = camera.ideal(joints);
    const RigidTransform model_T_camera = camera_T_model(cell, joints).inverse();
    int pixels = 0, looked_at = 0;
    for (int v = 0; v < cell.height; ++v)
      for (int u = 0; u < cell.width; ++u) {
        if (view.object[static_cast<size_t>(v * cell.width + u)] != CellCamera::kModel || ++pixels % 20 != 0)
          continue;
        const double z = static_cast<double>(view.depth.at(u, v));
        const Eigen::Vector3d seen(z * (u - cell.camera.cx) / cell.camera.fx,
                                   z * (v - cell.camera.cy) / cell.camera.fy, z);
        const Eigen::Vector3f point = (model_T_camera * seen).cast<float>();
        float nearest = 1;
        for (const Eigen::Vector3f& vertex : cell.model.vertices)
          nearest = std::min(nearest, (vertex - point).norm());
        EXPECT_LT(nearest, 0.0015f) << u << ' ' << v;  // the vertices are 1.5 mm apart
        ++looked_at;
      }
    EXPECT_GT(looked_at, 60);
  }
}

TEST(CellCamera, TipOfTheDrillIsInTheMiddle) {
  const WorkCell cell = phantom_cell();
  const RenderedView view = CellCamera(cell, cell.camera).ideal(standoff_start(cell, cell.plan.targets[0]));
  const auto object = [&](int u, int v) { return view.object[static_cast<size_t>(v * cell.width + u)]; };
  EXPECT_EQ(object(315, 287), CellCamera::kTool);  // the drill comes from the left
  EXPECT_NE(object(330, 287), CellCamera::kTool);
  EXPECT_NEAR(view.depth.at(318, 287), 0.545, 0.015);
}

TEST(CellCamera, NoiseIsThatOfItsSensor) {
  const WorkCell cell = phantom_cell();
  CellCameraOptions options;
  options.drift = 0;
  CellCamera camera(cell, cell.camera, options);
  const RenderedView truth = camera.ideal(cell.nominal);
  const DepthFrame frame = camera.capture(cell.nominal, 1);
  double sum = 0, squares = 0;
  int count = 0, holes = 0, too_near = 0, seen_too_near = 0;
  for (size_t i = 0; i < truth.object.size(); ++i) {
    const double z = static_cast<double>(truth.depth.depth[i]);
    const double measured = static_cast<double>(frame.image.depth[i]);
    if (measured > 0) {
      EXPECT_TRUE(measured > 0.499 && measured < 3.87) << measured;
    }
    if (truth.object[i] == CellCamera::kTool && z < 0.45) ++too_near, seen_too_near += measured > 0;
    if (truth.object[i] != CellCamera::kTable || std::abs(measured - z) > 0.01) {
      holes += truth.object[i] == CellCamera::kModel && measured == 0;
      continue;
    }
    ++count, sum += measured - z, squares += (measured - z) * (measured - z);
  }
  ASSERT_GT(count, 200000);
  EXPECT_NEAR(sum / count, 0, 5e-5);
  EXPECT_NEAR(std::sqrt(squares / count), 0.0009, 0.0002);
  EXPECT_GT(holes, 20);  // at the outline
  EXPECT_GT(too_near, 5000);
  EXPECT_LT(seen_too_near, too_near / 50) << "flying pixels at the drill's outline only";
}

TEST(CellCamera, SameSeedSameBits) {
  const WorkCell cell = phantom_cell();
  const ToldEquipment told = draw_told(cell, {}, 1);
  CellCameraOptions options;
  CellCamera one(cell, told.camera, options), two(cell, told.camera, options);
  options.seed = 2;
  CellCamera other(cell, told.camera, options);
  const DepthFrame frame = one.capture(cell.nominal, 77);
  EXPECT_EQ(frame.image.depth, two.capture(cell.nominal, 77).image.depth);
  EXPECT_NE(frame.image.depth, other.capture(cell.nominal, 77).image.depth);
  EXPECT_NE(frame.image.depth, one.capture(cell.nominal, 78).image.depth);
  EXPECT_EQ(frame.sequence, 1);
  EXPECT_EQ(frame.capture_utime, 77);
  EXPECT_EQ(frame.intrinsics.fx, told.camera.fx);
  EXPECT_NE(frame.intrinsics.fx, cell.camera.fx);
}

TEST(CellCamera, DriftIsSlowAndBounded) {
  WorkCell cell = phantom_cell();
  cell.camera = {30, 30, 15.5, 15.5};  // small images: only the drift is looked at
  cell.width = cell.height = 32;
  CellCameraOptions options;
  CellCamera camera(cell, cell.camera, options);
  double least = 1, most = -1, last = camera.drift();
  for (int i = 0; i < 1000; ++i) {
    camera.capture(cell.nominal, i);
    EXPECT_LT(std::abs(camera.drift() - last), 1.2e-4);
    last = camera.drift();
    least = std::min(least, last), most = std::max(most, last);
  }
  EXPECT_GE(least, -0.0003);
  EXPECT_LE(most, 0.0003);
  EXPECT_GT(most - least, 0.0002);
}

TEST(CellCamera, NamesABadOption) {
  const WorkCell cell = phantom_cell();
  CellCameraOptions options;
  options.name = "";
  EXPECT_THROW(CellCamera(cell, cell.camera, options), InputError);
  options = {};
  options.sensor.noise = -1;
  EXPECT_THROW(CellCamera(cell, cell.camera, options), InputError);
}

}  // namespace
}  // namespace edgepose
