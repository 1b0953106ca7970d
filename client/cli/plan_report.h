#pragma once
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "client/cli/match_report.h"
#include "files/drill_plan.h"
#include "render/overlay.h"

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

struct PlanReport {
  std::vector<PlacedTarget> targets;
};

/// Carries the plan's holes to every accepted pose, and the pose's covariance with them.
PlanReport report_plan(const DrillPlan& plan, const NamedResult& found);

nlohmann::json to_json(const PlanReport& report, const std::string& frame);
void print_table(std::ostream& out, const PlanReport& report, const std::string& frame);

/// As the overlay draws them.
std::vector<OverlayTarget> overlay_targets(const DrillPlan& plan);

}  // namespace edgepose
