#pragma once
#include <string>

namespace edgepose {

/// As calibration files have it: 2026-11-23T09:30:00Z.
std::string utc_now();

}  // namespace edgepose
