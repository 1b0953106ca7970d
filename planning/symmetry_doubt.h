#pragma once
#include "files/drill_plan.h"
#include "matcher/model.h"

namespace edgepose {

/// Whether the hole could as well be elsewhere: a symmetry of the model, which no pose estimate can tell
/// apart, moves it by more than its tolerances, and not onto another hole of the plan of the same size.
bool is_ambiguous(const DrillTarget& target, const DrillPlan& plan, const Symmetries& symmetries);

}  // namespace edgepose
