#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "experiment/virtual_cell.h"
#include "simulator/starts.h"
#include "tests/worst.h"

namespace edgepose::test {

inline constexpr const char* kTarget = "left_pedicle_screw";

/// The phantom under the arm. Made once.
inline const WorkCell& phantom_cell() {
  static const WorkCell cell = [] {
    const std::filesystem::path folder = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models/phantom";
    WorkCellOptions options;
    options.model = folder / "phantom.ply";
    options.plan = folder / "drill_plan.json";
    options.target = kTarget;
    return make_work_cell(options);
  }();
  return cell;
}

/// An arm and its controller in simulated time, with the true poses of a stand-in pose service and exact
/// calibrations. The seed draws the start and the moment of what is done to it.
class MovingArm {
 public:
  explicit MovingArm(uint64_t seed, VirtualCellOptions options = {},
                     const std::optional<SecretKey>& key = std::nullopt)
      : source(phantom_cell().plan, key, source_options()) {
    const WorkCell& cell = phantom_cell();
    options.key = key;
    if (options.arm.start.isZero()) options.arm.start = draw_start(cell, cell.find_target(kTarget), seed);
    const ToldCalibration told{cell.flange_T_camera, cell.flange_T_tool};
    virtual_cell = std::make_unique<VirtualCell>(
        cell, cell.plan.model, told, camera_T_tool(told),
        [this](const JointVector& joints, int64_t capture_utime) {
          return source.messages(camera_T_model(phantom_cell(), joints), capture_utime, capture_utime);
        },
        options);
    moment = 0.3 + 0.013 * static_cast<double>(seed % 31);
  }
  VirtualCell& operator*() { return *virtual_cell; }
  VirtualCell* operator->() { return virtual_cell.get(); }

  /// Arms, goes and is moving at the drawn moment.
  void set_out() {
    ASSERT_EQ(virtual_cell->set_out(kTarget, moment), "");
    ASSERT_TRUE(virtual_cell->is_moving());
    ASSERT_EQ(virtual_cell->controller.state(), ServoState::kApproaching);
  }
  /// [ms] until `holds` (looked at each ms, from now); -1 if it did not within `limit`.
  int ms_until(const std::function<bool()>& holds, int limit = 2000) {
    int at = -1, now = 0;
    virtual_cell->each_ms = [&] {
      ++now;
      if (at < 0 && holds()) at = now;
    };
    while (at < 0 && now < limit) virtual_cell->cycle();
    virtual_cell->each_ms = [] {};
    return at;
  }
  int ms_to_rest(int limit = 3000) {
    return ms_until([&] { return !virtual_cell->is_moving(); }, limit);
  }
  /// No drive follows set points any more.
  bool all_stop() const {
    for (int i = 0; i < kJoints; ++i)
      if (virtual_cell->arm.drive(i).state() == DriveState::kOperationEnabled) return false;
    return true;
  }
  /// The largest change of any joint [rad] during the next `seconds`.
  double motion_during(double seconds) {
    const JointVector before = virtual_cell->arm.position();
    double most = 0;
    virtual_cell->each_ms = [&] {
      most = std::max(most, (virtual_cell->arm.position() - before).cwiseAbs().maxCoeff());
    };
    virtual_cell->run(seconds);
    virtual_cell->each_ms = [] {};
    return most;
  }

  PoseSource source;
  std::unique_ptr<VirtualCell> virtual_cell;
  double moment = 0;  ///< [s] after go

 private:
  static PoseSourceOptions source_options() {
    PoseSourceOptions options;
    options.session = 1'700'000'000'000'000;
    return options;
  }
};

/// How often each fault is tried; EDGEPOSE_FAULT_REPETITIONS=100 is the soak.
inline int repetitions() {
  const char* text = std::getenv("EDGEPOSE_FAULT_REPETITIONS");
  return text == nullptr ? 20 : std::max(1, std::atoi(text));
}

}  // namespace edgepose::test
