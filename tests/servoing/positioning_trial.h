#pragma once
#include <string>
#include <vector>

#include "servoing/servo_law.h"
#include "tests/servoing/rig.h"

namespace edgepose {

/// What is wrong with what the controller is told: the paper's.
struct ToldNoise {
  double focal = 5;           ///< [pixels] sigma of fx and of fy
  double centre = 1;          ///< [pixels] of cx and of cy
  double calibration = 0.01;  ///< [rad] and [m] of each component of hand-eye and tool
};

enum class GoalSource { kOneShot, kCalibrated, kExact, kTaughtSame, kTaughtOther };

struct TrialSetup {
  GoalSource source = GoalSource::kExact;
  ToldNoise noise;
  double distance = 0.35;        ///< [m] of the camera from the tip
  int references = 5;            ///< of kTaughtOther
  double touch_sigma = 0;        ///< [m] a component: how well the tool is brought to a reference ...
  double touch_angle_sigma = 0;  ///< [rad] ... likewise
};

struct TrialResult {
  GoalError error;  ///< of the true tool, at the end
  int steps = 0;  ///< of 2 s until the measured pose was within 0.3 mm and 0.2 degrees of its goal; 21: never
};

/// One positioning with ideal correspondences: the camera sees 60 points of the model without error and takes
/// the pose that fits them best under the intrinsics it is told. At most 20 steps of gain 0.8, from a random
/// start within 100 mm and 20 degrees. The draws depend on the seed only, so that set-ups are compared on the
/// same.
TrialResult positioning_trial(const TrialSetup& setup, uint64_t seed);

}  // namespace edgepose
