#include "servoing/joint_history.h"

#include <algorithm>
#include <cmath>

#include "matcher/option_range.h"

namespace edgepose {

std::string JointHistoryOptions::check() const {
  return option_fault({{"history.length", length, 0.01, 60},
                       {"history.max_gap", max_gap, 1e-4, 1},
                       {"history.max_extrapolation", max_extrapolation, 0, 0.1}});
}

bool JointHistory::add(double time, const JointVector& position) {
  if (!std::isfinite(time) || !position.allFinite()) return false;
  if (!states_.empty() && !(time > states_.back().time)) return false;
  states_.push_back({time, position});
  while (states_.front().time < time - options_.length) states_.pop_front();
  return true;
}

std::optional<JointVector> JointHistory::at(double time) const {
  if (states_.empty() || !(time >= states_.front().time)) return std::nullopt;
  const State& newest = states_.back();
  if (time >= newest.time)
    return time - newest.time <= options_.max_extrapolation ? std::optional(newest.position) : std::nullopt;
  const auto later = std::upper_bound(states_.begin(), states_.end(), time,
                                      [](double t, const State& state) { return t < state.time; });
  const State &after = *later, &before = *(later - 1);
  if (after.time - before.time > options_.max_gap) return std::nullopt;
  const double share = (time - before.time) / (after.time - before.time);
  return JointVector(before.position + share * (after.position - before.position));
}

}  // namespace edgepose
