#pragma once
#include <limits>
#include <string>
#include <vector>

namespace edgepose::bench {

/// One point of a curve; what is NaN stays empty in the file.
struct CurvePoint {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::string curve;                   ///< "models"
  std::string variant;                 ///< "cropped"; may be empty
  double x = 0;                        ///< points, models, threads, or [s] the deadline; infinite for none
  double median = kNone, p99 = kNone;  ///< [s]
  double further = kNone;              ///< [s] for each further model
  double correct_005 = kNone, correct_010 = kNone;  ///< [0, 1] share of poses below 0.05 and 0.10 d
};

/// The curves of a run as CSV, for bench/plot_speed.sh: times in ms, shares in percent.
class CurveFile {
 public:
  explicit CurveFile(std::string set = "") : set_(std::move(set)) {}
  void add(CurvePoint point) { points_.push_back(std::move(point)); }
  std::string csv() const;

 private:
  std::string set_;
  std::vector<CurvePoint> points_;
};

}  // namespace edgepose::bench
