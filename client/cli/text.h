#pragma once
#include <numbers>
#include <string>

namespace edgepose {

/// One radian, in the degrees that people read.
inline constexpr double kDegrees = 180 / std::numbers::pi;

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// As many decimals as will be printed, and no "-0.00".
double rounded(double value, int decimals);

}  // namespace edgepose
