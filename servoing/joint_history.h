#pragma once
#include <deque>
#include <optional>
#include <string>

#include "arm/types.h"

namespace edgepose {

struct JointHistoryOptions {
  double length = 2;      ///< [s] kept: the oldest capture that can be placed; memory
  double max_gap = 0.03;  ///< [s] between two states that are interpolated
  double max_extrapolation =
      0.01;  ///< [s] beyond the newest; in it the arm is taken to stand where it was last

  std::string check() const;
};

/// Where the joints were: measured positions of the last seconds, on the steady clock. Not safe for use by
/// several threads at once.
class JointHistory {
 public:
  explicit JointHistory(const JointHistoryOptions& options) : options_(options) {}

  /// Takes a measured state. Refused (false) if it is not finite, or not later than the last: the clock is
  /// steady, so such a state is old or double.
  bool add(double time, const JointVector& position);

  /// The joints at `time`, interpolated linearly; none if that time was not measured, or lies in a gap.
  std::optional<JointVector> at(double time) const;

  void clear() { states_.clear(); }
  size_t size() const { return states_.size(); }

 private:
  struct State {
    double time;           ///< [s]
    JointVector position;  ///< [rad]
  };
  JointHistoryOptions options_;
  std::deque<State> states_;  ///< by time
};

}  // namespace edgepose
