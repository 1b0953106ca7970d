#include "simulator/cell_camera.h"

#include <algorithm>

#include "arm/kinematics.h"
#include "common/error.h"
#include "matcher/option_range.h"

namespace edgepose {
namespace {

const CellCameraOptions& checked(const CellCameraOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("camera: " + fault);
  return options;
}

}  // namespace

SensorModel kinect_narrow() {
  SensorModel sensor = SensorModel::time_of_flight();
  sensor.min_depth = 0.5;
  sensor.max_depth = 3.86;
  return sensor;
}

std::string CellCameraOptions::check() const {
  if (name.empty() || name.size() > 63)
    return "name: expected 1 to 63 bytes, found " + std::to_string(name.size());
  if (std::string fault = sensor.check(); !fault.empty()) return fault;
  return option_fault({{"drift", drift, 0, 0.05},
                       {"drift_step", drift_step, 0, 0.05},
                       {"threads", static_cast<double>(threads), 0, 256}});
}

CellCamera::CellCamera(const WorkCell& cell, const Camera& told, const CellCameraOptions& options)
    : cell_(cell),
      told_(told),
      options_(checked(options)),
      series_(options.sensor, cell.camera, cell.width, cell.height, options.seed),
      drift_draws_(options.seed, DrawPurpose::kDrift),
      sensor_draws_(options.seed, DrawPurpose::kSensor) {
  renderer_.add(cell.model);
  renderer_.add(cell.table);
  renderer_.add(cell.tool, cell.flange_T_camera.inverse() * cell.flange_T_tool);
  drift_ = options.drift * (2 * drift_draws_.uniform() - 1);
}

const RenderedView& CellCamera::ideal(const JointVector& joints) {
  if (joints == view_joints_) return view_;  // an arm at rest sees the same
  const RigidTransform camera_T_base = (base_T_flange(cell_.arm, joints) * cell_.flange_T_camera).inverse();
  renderer_.set_pose(kModel, camera_T_base * cell_.base_T_model);
  renderer_.set_pose(kTable, camera_T_base * cell_.base_T_table);
  view_ = renderer_.render(cell_.camera, cell_.width, cell_.height, options_.threads);
  view_joints_ = joints;
  return view_;
}

DepthFrame CellCamera::capture(const JointVector& joints, int64_t capture_utime) {
  DepthImage truth = ideal(joints).depth;
  const auto offset = static_cast<float>(drift_);
  for (float& depth : truth.depth)
    if (depth > 0) depth += offset;
  DepthFrame frame;
  frame.capture_utime = capture_utime;
  frame.sequence = ++sequence_;
  frame.camera = options_.name;
  frame.intrinsics = told_;
  frame.image = series_.apply(truth, sensor_draws_.bits());
  drift_ = std::clamp(drift_ + options_.drift_step * drift_draws_.normal(), -options_.drift, options_.drift);
  return frame;
}

}  // namespace edgepose
