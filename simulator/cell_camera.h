#pragma once
#include <memory>
#include <string>

#include "messaging/depth_message.h"
#include "render/depth_renderer.h"
#include "render/sensor_series.h"
#include "simulator/random_draws.h"
#include "simulator/work_cell.h"

namespace edgepose {

/// The sensor of an Azure Kinect in its narrow field of view: time of flight, 0.5 to 3.86 m.
SensorModel kinect_narrow();

struct CellCameraOptions {
  std::string name = "flange";           ///< of the camera, as it stands in its frames; 1 to 63 bytes
  SensorModel sensor = kinect_narrow();  ///< what spoils the true depth
  double drift = 0.0003;        ///< [m] most that the whole image is off by: a slow random walk; 0: none
  double drift_step = 0.00002;  ///< [m] one standard deviation of its step from frame to frame
  uint64_t seed = 1;            ///< of noise and drift
  int threads = 1;              ///< for rendering, 0 = all cores; the result does not depend on it

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// The depth camera on the flange: sees bone, table and drill. The same calls give the same bits. About
/// 30 ms a capture on one core (docs/simulator.md). Not safe for use by several threads at once.
class CellCamera {
 public:
  /// `told`: the intrinsics that its frames claim; the image is made with the true ones. `cell` must live
  /// longer. Throws InputError if an option is wrong.
  CellCamera(const WorkCell& cell, const Camera& told, const CellCameraOptions& options = {});

  /// What it sees at these joint positions [rad]. `capture_utime`: [us] since 1970, UTC. The sequence counts
  /// from 1.
  DepthFrame capture(const JointVector& joints, int64_t capture_utime);

  /// Without noise, and what each pixel shows.
  enum Object : int32_t { kNothing = -1, kModel, kTable, kTool };
  const RenderedView& ideal(const JointVector& joints);

  double drift() const { return drift_; }  ///< [m] of the last capture

 private:
  const WorkCell& cell_;
  const Camera told_;
  const CellCameraOptions options_;
  DepthRenderer scene_;  ///< bone and table, in the frame of the bone
  RenderedView tool_;    ///< the drill, which the camera always sees alike
  const SensorSeries series_;
  RandomDraws drift_draws_, sensor_draws_;
  double drift_ = 0;
  RenderedView view_;                                     ///< of the last call of ideal() ...
  JointVector view_joints_ = JointVector::Constant(NAN);  ///< ... at these joints
  int64_t sequence_ = 0;
};

}  // namespace edgepose
