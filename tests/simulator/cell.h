#pragma once
#include <string>

#include "simulator/work_cell.h"

namespace edgepose {

/// The project's phantom in the work cell; `target` empty: the plan's first.
inline WorkCell phantom_cell(const std::string& target = "") {
  const std::string folder = std::string(EDGEPOSE_SOURCE_DIR) + "/models/phantom/";
  WorkCellOptions options;
  options.model = folder + "phantom.ply";
  options.plan = folder + "drill_plan.json";
  options.target = target;
  return make_work_cell(options);
}

}  // namespace edgepose
