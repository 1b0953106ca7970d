#include "bench/speed/curve_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace edgepose::bench {
namespace {

std::string cell(double value, double factor) {
  if (std::isnan(value)) return ",";
  if (std::isinf(value)) return ",none";
  char text[32];
  std::snprintf(text, sizeof text, ",%.6g", factor * value);
  return text;
}

/// Names of folders may hold anything; neither CSV nor gnuplot may take it for syntax.
std::string plain(std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) {
        return c < ' ' || c > '~' || std::string("\",'`\\$@").find(static_cast<char>(c)) != std::string::npos;
      },
      ' ');
  return name;
}

}  // namespace

std::string CurveFile::csv() const {
  std::string text =
      "curve,set,variant,x,median_ms,p99_ms,further_ms,correct_005_percent,correct_010_percent\n";
  for (const CurvePoint& p : points_)
    text += p.curve + "," + plain(set_) + "," + p.variant + cell(p.x, p.curve == "deadline" ? 1e3 : 1) +
            cell(p.median, 1e3) + cell(p.p99, 1e3) + cell(p.further, 1e3) + cell(p.correct_005, 100) +
            cell(p.correct_010, 100) + "\n";
  return text;
}

}  // namespace edgepose::bench
