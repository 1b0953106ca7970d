#include "client/cli/plan_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "client/cli/text.h"

namespace edgepose {
namespace {

using nlohmann::json;

json to_array(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

PlanReport report_plan(const DrillPlan& plan, const NamedResult& found) {
  return {place_targets(plan, found.result.detections, found.centre)};
}

json to_json(const PlanReport& report, const std::string& frame) {
  json rows = json::array();
  for (const PlacedTarget& placed : report.targets) {
    rows.push_back({{"name", placed.target.name},
                    {"instance", placed.instance},
                    {"frame", frame},
                    {"entry_m", to_array(placed.target.entry)},
                    {"axis", to_array(placed.target.axis)},
                    {"depth_m", placed.target.depth},
                    {"diameter_m", placed.target.diameter},
                    {"entry_sigma_m", placed.entry_sigma},
                    {"bottom_sigma_m", placed.bottom_sigma},
                    {"angle_sigma_rad", placed.angle_sigma},
                    {"position_tolerance_m", placed.target.position_tolerance},
                    {"angle_tolerance_rad", placed.target.angle_tolerance},
                    {"two_sigma_within_tolerance", placed.certain}});
  }
  return rows;
}

void print_table(std::ostream& out, const PlanReport& report, const std::string& frame) {
  out << formatted("\n%-22s %26s  %20s  %8s  %14s  %s\n", "target", ("entry in " + frame + " [mm]").c_str(),
                   "axis", "depth mm", "2 sigma mm deg", "within tolerance");
  for (const PlacedTarget& placed : report.targets) {
    const Eigen::Vector3d entry =
        (1e3 * placed.target.entry).unaryExpr([](double value) { return rounded(value, 2); });
    const Eigen::Vector3d axis = placed.target.axis.unaryExpr([](double value) { return rounded(value, 3); });
    out << formatted(
        "%-22.22s %8.2f %8.2f %8.2f  %6.3f %6.3f %6.3f  %8.1f  %7.3f %6.3f  %s (%.1f mm, %.1f deg)\n",
        placed.target.name.c_str(), entry.x(), entry.y(), entry.z(), axis.x(), axis.y(), axis.z(),
        1e3 * placed.target.depth, 2e3 * std::max(placed.entry_sigma, placed.bottom_sigma),
        2 * kDegrees * placed.angle_sigma, placed.certain ? "yes" : "NO",
        1e3 * placed.target.position_tolerance, kDegrees * placed.target.angle_tolerance);
  }
}

std::vector<OverlayTarget> overlay_targets(const DrillPlan& plan) {
  std::vector<OverlayTarget> targets;
  for (const DrillTarget& target : plan.targets) {
    targets.push_back({target.name, target.entry, target.axis, target.depth, target.diameter});
  }
  return targets;
}

}  // namespace edgepose
