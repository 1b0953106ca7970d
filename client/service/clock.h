#pragma once
#include <chrono>
#include <cstdint>

namespace edgepose {

using SteadyTime = std::chrono::steady_clock::time_point;

/// [us] since 1970, UTC.
inline int64_t utime_now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// `seconds` as the steady clock counts; at most a century.
inline std::chrono::nanoseconds steady_seconds(double seconds) {
  constexpr double kMost = 3e9;
  return std::chrono::nanoseconds(static_cast<int64_t>(1e9 * (seconds < kMost ? seconds : kMost)));
}

/// Where the sequence numbers of a run begin: those of a later run are higher, as cameras send fewer than a
/// thousand frames a second. [ms] since 1970.
inline int64_t first_sequence() { return utime_now() / 1000; }

}  // namespace edgepose
