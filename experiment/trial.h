#pragma once
#include <functional>
#include <string>
#include <vector>

#include "experiment/matcher_feed.h"
#include "servoing/servo.h"
#include "servoing/teaching.h"
#include "simulator/told.h"

namespace edgepose {

/// How the goal of a positioning is known. The letters are those of docs/servoing.md.
enum class GoalKind : uint8_t {
  kOneShot,     ///< A: from the calibrations; three looks, then blindly there
  kCalibrated,  ///< B: from the calibrations, closed loop
  kExact,       ///< C: the pose in which the camera is to see the model is given
  kTaughtOne,   ///< D1: taught at one place, the hole itself
  kTaughtFive,  ///< D5: taught at five other places
};

/// One row of the experiment's table.
struct ExperimentArm {
  std::string name;
  GoalKind goal = GoalKind::kExact;
  ToldNoise noise;
  double touch = 0;        ///< [m] a component: how well the tool is brought to a taught place (sigma) ...
  double touch_angle = 0;  ///< [rad] ... likewise
};

struct TrialOptions {
  int taught_poses = 30;      ///< of each reference
  double frame_period = 0.5;  ///< [s] between frames: a real camera gives more; each costs time here
  double latency = 0.1;       ///< [s] from capture to the pose's arrival
  double step = 2;            ///< [s] the time is reported in steps ...
  int max_steps = 20;         ///< ... and a trial has so many
  ServoOptions servo;         ///< pose_timeout is made to fit the frame period

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

struct TrialResult {
  uint64_t seed = 0;
  std::string end;         ///< "converged", or why not
  PositioningError error;  ///< of the true tip against the hole, at the end
  int steps = 0;           ///< that were begun
  /// After each step, the first before it: [m], [rad] of the true tip from the hole.
  std::vector<double> distances, angles;

  bool within(double metres, double radians) const {
    return end == "converged" && error.translation <= metres && error.angle <= radians;
  }
};

/// One positioning at the cell's target, in simulated time: the controller's own code, frames rendered, noisy
/// and looked at by the pose service's own code, CANopen on a wire in memory. The draws (start, what is told,
/// noise of the camera) depend on the seed only, so that arms are compared on the same. The same result for
/// the same arguments.
TrialResult run_trial(const WorkCell& cell, const ModelHandle& model, const ExperimentArm& arm, uint64_t seed,
                      const TrialOptions& options);

/// Called before each look at a place, with the poses measured there so far. What it throws ends the
/// teaching.
using TeachingNote = std::function<void(const std::string& place, int poses)>;

/// Where the camera sees the tool, learned with the true tool at five places of the model (kTaughtOne: at the
/// target itself), `poses` at each, up to the touch's error. `told`: intrinsics that the frames claim. Throws
/// InputError if the model was not found often enough.
TaughtTool taught_tool(const WorkCell& cell, const ModelHandle& model, const Camera& told,
                       const ExperimentArm& arm, uint64_t seed, int poses, const TeachingNote& note = {});
RigidTransform taught_camera_T_tool(const WorkCell& cell, const ModelHandle& model, const Camera& told,
                                    const ExperimentArm& arm, uint64_t seed, int poses);

}  // namespace edgepose
