#include <cmath>
#include <numbers>

#include "files/drill_plan.h"
#include "fuzz/input_check.h"

namespace {

using namespace edgepose;

void check(const DrillPlan& plan) {
  must_hold(!plan.model.empty() && plan.model_diameter > 0 && !plan.targets.empty());
  for (const DrillTarget& target : plan.targets) {
    must_hold(!target.name.empty() && target.entry.allFinite());
    must_hold(std::abs(target.axis.norm() - 1) < 1e-9);
    must_hold(target.depth > 0 && target.diameter > 0 && target.position_tolerance > 0);
    must_hold(target.angle_tolerance > 0 && target.angle_tolerance <= std::numbers::pi / 2 + 1e-9);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  reads([&] {
    const DrillPlan plan = parse_drill_plan(text_of(data, size), "plan.json");
    check(plan);
    reads([&] { check_drill_plan(plan, Eigen::Vector3d::Zero(), 0.1, "plan.json"); });
    // What was read can be written; reading it again refuses at most what rounding put over a limit.
    reads([&] { check(parse_drill_plan(format_drill_plan(plan), "again.json")); });
  });
  return 0;
}
