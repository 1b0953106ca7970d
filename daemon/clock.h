#pragma once
#include <chrono>
#include <cstdint>

namespace edgepose {

/// [us] since 1970, UTC: what messages carry.
inline int64_t utime_now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace edgepose
