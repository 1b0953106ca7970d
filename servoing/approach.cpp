#include "servoing/approach.h"

#include <algorithm>

#include "matcher/option_range.h"

namespace edgepose {
namespace {

// Of the axial speed that the goal moves with; the rest is left to the law, for corrections.
constexpr double kGoalShare = 0.8;

}  // namespace

std::string ApproachOptions::check() const {
  return option_fault({{"approach.standoff", standoff, 0.03, 0.05},
                       {"approach.free_speed", free_speed, 1e-4, 0.25},
                       {"approach.axial_speed", axial_speed, 1e-5, free_speed},
                       {"approach.max_translation", max_translation, 1e-6, 0.01},
                       {"approach.max_rotation", max_rotation, 1e-6, 0.1},
                       {"approach.distinct_poses", static_cast<double>(distinct_poses), 1, 1000},
                       {"approach.tube_translation", tube_translation, max_translation, 0.01},
                       {"approach.tube_rotation", tube_rotation, max_rotation, 0.1}});
}

bool Convergence::add(const GoalError& error) {
  const bool near = error.translation < options_.max_translation && error.rotation < options_.max_rotation;
  in_a_row_ = near ? in_a_row_ + 1 : 0;
  return in_a_row_ >= options_.distinct_poses;
}

double next_standoff(double standoff, const GoalError& error, double seconds,
                     const ApproachOptions& options) {
  const bool in_tube =
      error.translation <= options.tube_translation && error.rotation <= options.tube_rotation;
  return in_tube ? std::max(0.0, standoff - kGoalShare * options.axial_speed * seconds) : standoff;
}

}  // namespace edgepose
