#pragma once
#include <algorithm>

#include "matcher/match_options.h"

namespace edgepose {

/// Longest deadline, as of MatchOptions::max_seconds.
inline constexpr double kLongestDeadline = 3600;  // [s]

/// `options` with what is left of `deadline` [s] after `spent` [s] on preprocessing as their max_seconds,
/// whatever that was before; `deadline` 0 = none, and nothing changes. A microsecond remains of a time that
/// is over, as 0 would mean no limit: the search ends as soon as it can.
inline MatchOptions within_deadline(MatchOptions options, double deadline, double spent) {
  constexpr double kLeast = 1e-6;
  if (deadline > 0) options.max_seconds = std::clamp(deadline - spent, kLeast, kLongestDeadline);
  return options;
}

}  // namespace edgepose
