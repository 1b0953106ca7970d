#pragma once
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "client/cli/match_report.h"
#include "files/drill_plan.h"
#include "planning/placed_target.h"
#include "render/overlay.h"

namespace edgepose {

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
