#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "arm/types.h"

namespace edgepose {

/// The arm as the controller saw it, of the controller's own log. Times are [s] since it set out.
struct ControlPoint {
  double time = 0;
  std::string state;
  bool goal_seen = false;
  double tool_error = 0, tool_angle = 0;         ///< [m], [rad] of the tool to where it is to be now ...
  double standoff = 0;                           ///< [m] ... and that place before the entry
  std::array<double, 6> features{}, velocity{};  ///< t [m], theta u [rad]; of the camera [m/s], [rad/s]
};

/// The arm as it truly was, of the simulator's log.
struct TruthPoint {
  double time = 0;
  JointVector joints = JointVector::Zero();  ///< [rad]
  double along = 0, across = 0, angle = 0;   ///< [m] past the entry, [m] from the axis, [rad]
  double distance() const;                   ///< [m] of the tip from the entry
};

/// What happened from the moment the arm set out to `end_ns`, every 20 ms.
struct RunTrack {
  std::vector<ControlPoint> control;
  std::vector<TruthPoint> truth;

  const ControlPoint& control_at(double time) const;  ///< the nearest
  const TruthPoint& truth_at(double time) const;
  double end() const { return truth.back().time; }
  /// [s] when the controller last knew its own error: it stops looking once it has converged.
  double seen_last() const;
  /// [s] when the controller first said converged; -1: never.
  double converged() const;
};

/// Reads both logs, whose times are of one steady clock; `end_ns` on it. Throws InputError if one cannot be
/// read or the arm never set out.
RunTrack read_track(const std::filesystem::path& control_log, const std::filesystem::path& truth_log,
                    int64_t end_ns);

}  // namespace edgepose
