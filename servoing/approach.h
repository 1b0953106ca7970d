#pragma once
#include <string>

#include "servoing/servo_law.h"

namespace edgepose {

/// How a hole is come to: free to a point before it, then along its axis to the touch.
struct ApproachOptions {
  double standoff = 0.04;      ///< [m] 0.03 to 0.05: of the tip before the entry, where the free motion ends
  double free_speed = 0.05;    ///< [m/s] of the tip, at most, up to the standoff
  double axial_speed = 0.005;  ///< [m/s] ... from there
  double max_translation =
      0.0003;  ///< [m] error below which the standoff, and the entry, count as reached ...
  double max_rotation = 0.0034907;   ///< [rad] ... likewise: 0.2 degrees
  int distinct_poses = 5;            ///< in a row that must find it so
  double tube_translation = 0.001;   ///< [m] error to the moving goal beyond which it waits on the axis ...
  double tube_rotation = 0.0087266;  ///< [rad] ... likewise: 0.5 degrees

  std::string check() const;
};

/// Counts the distinct poses in a row that find the tool at its goal.
class Convergence {
 public:
  explicit Convergence(const ApproachOptions& options) : options_(options) {}

  /// Once for each pose taken. True from the last of enough in a row on.
  bool add(const GoalError& error);
  void restart() { in_a_row_ = 0; }
  int in_a_row() const { return in_a_row_; }

 private:
  ApproachOptions options_;
  int in_a_row_ = 0;
};

/// Where the goal on the axis is in the next cycle: `standoff` [m] before the entry, moved on by `seconds` at
/// four fifths of the axial speed, never past 0; as long as the tool follows within the tube, else it waits.
/// Pure.
double next_standoff(double standoff, const GoalError& error, double seconds, const ApproachOptions& options);

}  // namespace edgepose
