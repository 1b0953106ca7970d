#include "simulator/cell_camera.h"

#include <algorithm>

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
  scene_.add(cell.model);
  scene_.add(cell.table, cell.base_T_model.inverse() * cell.base_T_table);
  DepthRenderer tool;
  tool.add(cell.tool, cell.flange_T_camera.inverse() * cell.flange_T_tool);
  tool_ = tool.render(cell.camera, cell.width, cell.height, options.threads);
  drift_ = options.drift * (2 * drift_draws_.uniform() - 1);
}

const RenderedView& CellCamera::ideal(const JointVector& joints) {
  if (joints == view_joints_) return view_;  // an arm at rest sees the same
  const RigidTransform model_T_camera = camera_T_model(cell_, joints).inverse();
  view_ = scene_.render(cell_.camera, cell_.width, cell_.height, options_.threads, model_T_camera);
  for (size_t i = 0; i < view_.object.size(); ++i) {
    const float tool = tool_.depth.depth[i], behind = view_.depth.depth[i];
    if (tool_.object[i] < 0 || (view_.object[i] >= 0 && behind <= tool)) continue;
    view_.depth.depth[i] = tool;
    view_.object[i] = kTool;
  }
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
