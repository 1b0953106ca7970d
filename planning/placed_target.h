#pragma once
#include <vector>

#include "files/drill_plan.h"
#include "matcher/match.h"

namespace edgepose {

/// A planned hole where it was found, and how sure that is. SI units, in the frame of the result.
struct PlacedTarget {
  DrillTarget target;       ///< entry and axis in the result's frame
  size_t instance = 0;      ///< index of the detection
  double entry_sigma = 0;   ///< [m] one standard deviation across the axis, worst direction, at the entry
  double bottom_sigma = 0;  ///< [m] ... at the bottom of the hole
  double angle_sigma = 0;   ///< [rad] ... of the axis
  /// Two standard deviations stay within the plan's tolerances; false where the covariance is not known (all
  /// zero: the pose was not refined). Says nothing about the camera's own errors.
  bool certain = false;
};

/// Carries the plan's holes to every accepted pose, and the pose's covariance with them. `model_centre`: [m]
/// model frame, Model::centre().
std::vector<PlacedTarget> place_targets(const DrillPlan& plan, const std::vector<Detection>& detections,
                                        const Eigen::Vector3d& model_centre);

}  // namespace edgepose
