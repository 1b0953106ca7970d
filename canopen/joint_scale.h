#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace edgepose {

/// Between radians and what drives count in: positions [counts], velocities [counts/s], accelerations
/// [counts/s^2] (6064, 606C, 6085). At the joint, behind the gear; 2^20 counts a turn are 6 urad each. The
/// only place where counts and radians meet.
struct JointScale {
  double counts_per_turn = 1 << 20;

  double counts_per_radian() const { return counts_per_turn / (2 * std::numbers::pi); }
  /// To the nearest; at most what 32 bits hold. `radians` must be finite.
  int32_t to_counts(double radians) const {
    return static_cast<int32_t>(
        std::clamp<double>(std::round(radians * counts_per_radian()), INT32_MIN, INT32_MAX));
  }
  double to_radians(int32_t counts) const { return counts / counts_per_radian(); }
};

}  // namespace edgepose
