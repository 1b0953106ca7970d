#include "experiment/trial.h"

#include <algorithm>
#include <cmath>

#include "arm/kinematics.h"
#include "common/error.h"
#include "experiment/virtual_cell.h"
#include "matcher/option_range.h"
#include "servoing/pose_mean.h"
#include "simulator/starts.h"

namespace edgepose {
namespace {

constexpr int kFirstLooks = 3;  // of the one-shot arm, averaged

RigidTransform goal_of(const WorkCell& cell, const ModelHandle& model, const ExperimentArm& arm,
                       const ToldEquipment& told, uint64_t seed, int poses) {
  switch (arm.goal) {
    case GoalKind::kOneShot:
    case GoalKind::kCalibrated:
      return camera_T_tool({told.flange_T_camera, told.flange_T_tool});
    case GoalKind::kExact:
      return camera_T_tool({cell.flange_T_camera, cell.flange_T_tool});
    case GoalKind::kTaughtOne:
    case GoalKind::kTaughtFive:
      return taught_camera_T_tool(cell, model, told.camera, arm, seed, poses);
  }
  return RigidTransform::Identity();
}

/// Looks a few times, then says only where the model would be seen from, by the arm's own motion and the
/// calibration that it was told: no look corrects it any more.
class OneShotFeed {
 public:
  OneShotFeed(MatcherFeed& camera, const WorkCell& cell, const ToldEquipment& told)
      : camera_(camera), cell_(cell), told_(told), source_(cell.plan, std::nullopt) {}

  std::vector<OutgoingMessage> messages(const JointVector& joints, int64_t capture_utime) {
    const RigidTransform base_T_camera = base_T_flange(cell_.arm, joints) * told_.flange_T_camera;
    if (static_cast<int>(seen_.size()) < kFirstLooks) {
      const auto pose = camera_.pose(joints, capture_utime);
      if (!pose) return {};
      seen_.push_back(base_T_camera * *pose);
    }
    if (static_cast<int>(seen_.size()) < kFirstLooks) return {};
    return source_.messages(base_T_camera.inverse() * mean_pose(seen_), capture_utime, capture_utime);
  }

 private:
  MatcherFeed& camera_;
  const WorkCell& cell_;
  const ToldEquipment& told_;
  PoseSource source_;
  std::vector<RigidTransform> seen_;  ///< base_T_model
};

VirtualCellOptions cell_options(const TrialOptions& options, const JointVector& start) {
  VirtualCellOptions all;
  all.pose_period = options.frame_period;
  all.pose_latency = options.latency;
  all.servo = options.servo;
  all.servo.pose_timeout = std::max(options.servo.pose_timeout, 2 * options.frame_period + options.latency);
  all.arm.start = start;
  return all;
}

void note(const VirtualCell& cell, const DrillTarget& target, TrialResult& result) {
  result.error = cell.error(target);
  result.distances.push_back(result.error.translation);
  result.angles.push_back(result.error.angle);
}

/// Arms, waits for the first poses, says go until the service agrees, for as long as a trial lasts. Empty, or
/// why not.
std::string begin(VirtualCell& cell, const std::string& target, const TrialOptions& options) {
  if (std::string refusal = cell.request({ArmCommand::kArm, {}}); !refusal.empty()) return refusal;
  cell.run(4 * options.frame_period + options.latency);
  std::string refusal = cell.go(target);
  for (double waited = 0; !refusal.empty() && waited < options.max_steps * options.step;
       waited += options.frame_period) {
    cell.run(options.frame_period);
    refusal = cell.go(target);
  }
  return refusal;
}

}  // namespace

std::string TrialOptions::check() const {
  if (const std::string fault = servo.check(); !fault.empty()) return fault;
  return option_fault({{"taught_poses", static_cast<double>(taught_poses), 1, 10000},
                       {"frame_period", frame_period, 0.01, 10},
                       {"latency", latency, 0, 1},
                       {"step", step, 0.1, 60},
                       {"max_steps", static_cast<double>(max_steps), 1, 1000}});
}

TrialResult run_trial(const WorkCell& cell, const ModelHandle& model, const ExperimentArm& arm, uint64_t seed,
                      const TrialOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("trial: " + fault);
  const DrillTarget& target = cell.find_target(cell.target);
  const ToldEquipment told = draw_told(cell, arm.noise, seed);
  TrialResult result;
  result.seed = seed;

  CellCameraOptions camera;
  camera.seed = seed;
  MatcherFeed matcher(cell, model, told.camera, camera);
  OneShotFeed one_shot(matcher, cell, told);
  const PoseFeed feed = [&](const JointVector& joints, int64_t capture_utime) {
    return arm.goal == GoalKind::kOneShot ? one_shot.messages(joints, capture_utime)
                                          : matcher.messages(joints, capture_utime);
  };
  const ToldCalibration calibration{told.flange_T_camera, told.flange_T_tool};
  const JointVector start = draw_start(cell, target, seed);
  RigidTransform goal;
  try {
    goal = goal_of(cell, model, arm, told, seed, options.taught_poses);
  } catch (const InputError& error) {
    result.end = std::string("could not be taught: ") + error.what();
    result.error = positioning_error(cell, start, target);
    return result;
  }
  VirtualCell trial(cell, cell.plan.model, calibration, goal, feed, cell_options(options, start));
  result.end = begin(trial, cell.target, options);
  note(trial, target, result);
  if (!result.end.empty()) return result;

  const auto has_ended = [&] {
    return trial.controller.state() == ServoState::kConverged ||
           trial.controller.state() == ServoState::kFault;
  };
  result.end = "not there after " + std::to_string(options.max_steps) + " steps";
  for (int step = 0; step < options.max_steps && !has_ended(); ++step) {
    trial.run_until(has_ended, options.step);
    ++result.steps;
    note(trial, target, result);
  }
  if (trial.controller.state() == ServoState::kConverged) result.end = "converged";
  if (trial.controller.state() == ServoState::kFault) result.end = trial.controller.fault_text();
  return result;
}

}  // namespace edgepose
