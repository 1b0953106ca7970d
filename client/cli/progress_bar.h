#pragma once
#include <functional>
#include <string>

namespace edgepose {

/// A bar on stderr, redrawn in place; silent if stderr is not a terminal. The returned function takes the
/// share done, 0 to 1, from one thread at a time; it removes the bar at 1 and when it is destroyed.
std::function<void(double)> progress_bar(const std::string& label);

/// "LABEL: 12 s" on stderr, redrawn in place; silent if stderr is not a terminal. The returned function takes
/// the seconds so far; less than 0 removes it.
std::function<void(double)> elapsed_time(const std::string& label);

}  // namespace edgepose
