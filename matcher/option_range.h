#pragma once
#include <initializer_list>
#include <sstream>
#include <string>

namespace edgepose {

/// An option and the range it may have; NaN is in none.
struct OptionRange {
  const char* name;
  double value, least, most;
};

/// What is wrong with the first option out of its range, its name first; empty if none is.
inline std::string option_fault(std::initializer_list<OptionRange> ranges) {
  for (const OptionRange& r : ranges) {
    if (r.value >= r.least && r.value <= r.most) continue;
    std::ostringstream text;
    text << r.name << ": expected " << r.least << " to " << r.most << ", found " << r.value;
    return text.str();
  }
  return "";
}

}  // namespace edgepose
