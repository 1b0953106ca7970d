#include "files/drill_plan.h"

#include <cmath>
#include <numbers>
#include <set>

#include "common/atomic_file.h"
#include "files/json_node.h"
#include "files/number_text.h"
#include "files/text_cursor.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kDegree = std::numbers::pi / 180;
constexpr size_t kMaxPlanBytes = 1u << 20;
constexpr double kMaxLength = 10e3;  // mm; longer is a mistake of units
constexpr size_t kMaxTargets = 1000;

double length(const JsonNode& node) {
  const double value = node.positive();
  if (value > kMaxLength) node.fail("at most 10000 mm", "lengths are in millimetres");
  return value * kMillimetre;
}

std::string name_of(const JsonNode& node) {
  std::string name = node.text();
  if (trim(name).empty() || name.size() > 200) node.fail("a name of 1 to 200 characters");
  return name;
}

DrillTarget parse_target(const JsonNode& node) {
  DrillTarget target;
  target.name = name_of(node.at("name"));
  const JsonNode entry = node.at("entry_mm");
  target.entry = entry.vector() * kMillimetre;
  if (!(target.entry.stableNorm() <= kMaxLength))
    throw InputError::at(entry.where(), "a point within 10 km of the origin", "one beyond",
                         "lengths are in millimetres");
  target.axis = node.at("axis").direction();
  target.depth = length(node.at("depth_mm"));
  target.diameter = length(node.at("diameter_mm"));
  target.position_tolerance = length(node.at("tolerance_mm"));
  const JsonNode tolerance = node.at("tolerance_deg");
  target.angle_tolerance = tolerance.positive() * kDegree;
  if (tolerance.number() > 90) tolerance.fail("at most 90 degrees");
  return target;
}

/// Holes lie in the model, so no two entries can be farther apart than it is large.
void check_spread(const DrillPlan& plan, const std::string& name) {
  for (const DrillTarget& a : plan.targets)
    for (const DrillTarget& b : plan.targets)
      if (const double distance = (a.entry - b.entry).norm(); distance > plan.model_diameter * 1.01)
        throw InputError::at(name,
                             "targets within the model's diameter of each other, " +
                                 number_text(plan.model_diameter / kMillimetre, 6) + " mm",
                             edgepose::quoted(a.name) + " and " + edgepose::quoted(b.name) + " " +
                                 number_text(distance / kMillimetre, 6) + " mm apart",
                             "all lengths are in millimetres");
}

}  // namespace

DrillPlan parse_drill_plan(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  const JsonNode root(json, name);
  DrillPlan plan;
  plan.model = name_of(root.at("model"));
  plan.model_diameter = length(root.at("model_diameter_mm"));
  const std::vector<JsonNode> targets = root.at("targets").items();
  if (targets.empty() || targets.size() > kMaxTargets) root.at("targets").fail("1 to 1000 targets");
  std::set<std::string> names;
  for (const JsonNode& node : targets) {
    plan.targets.push_back(parse_target(node));
    if (!names.insert(plan.targets.back().name).second)
      throw InputError::at(node.where(), "another name for each target",
                           edgepose::quoted(plan.targets.back().name) + " again");
  }
  check_spread(plan, name);
  return plan;
}

DrillPlan read_drill_plan(const std::filesystem::path& path) {
  return parse_drill_plan(read_whole_file(path, "a drill plan (JSON)", kMaxPlanBytes), path.string());
}

void check_drill_plan(const DrillPlan& plan, const Eigen::Vector3d& centre, double model_diameter,
                      const std::string& name) {
  const auto millimetres = [](double metres) { return number_text(metres / kMillimetre, 6) + " mm"; };
  if (!(std::abs(plan.model_diameter - model_diameter) <= 0.05 * model_diameter))
    throw InputError::at(name, "a plan for a model of diameter " + millimetres(model_diameter),
                         millimetres(plan.model_diameter), "the plan belongs to another model or unit");
  for (const DrillTarget& target : plan.targets)
    for (const Eigen::Vector3d& end :
         {target.entry, Eigen::Vector3d(target.entry + target.depth * target.axis)})
      if (const double distance = (end - centre).norm(); !(distance <= model_diameter))
        throw InputError::at(name + ": target " + edgepose::quoted(target.name),
                             "a hole within " + millimetres(model_diameter) + " of the model's centre",
                             millimetres(distance), "check frame and unit of the plan");
}

std::string format_drill_plan(const DrillPlan& plan) {
  // Nine digits carry a nanometre; more would only print the rounding of the conversion.
  const auto rounded = [](double value) { return *parse_number(number_text(value)); };
  nlohmann::ordered_json json;
  json["model"] = plan.model;
  json["model_diameter_mm"] = rounded(plan.model_diameter / kMillimetre);
  json["targets"] = nlohmann::ordered_json::array();
  for (const DrillTarget& target : plan.targets) {
    nlohmann::ordered_json& item = json["targets"].emplace_back();
    item["name"] = target.name;
    for (const double value : target.entry) item["entry_mm"].push_back(rounded(value / kMillimetre));
    for (const double value : target.axis) item["axis"].push_back(rounded(value));
    item["depth_mm"] = rounded(target.depth / kMillimetre);
    item["diameter_mm"] = rounded(target.diameter / kMillimetre);
    item["tolerance_mm"] = rounded(target.position_tolerance / kMillimetre);
    item["tolerance_deg"] = rounded(target.angle_tolerance / kDegree);
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write_drill_plan(const std::filesystem::path& path, const DrillPlan& plan) {
  write_file_atomically(path, std::string_view(format_drill_plan(plan)));
}

}  // namespace edgepose
