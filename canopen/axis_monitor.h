#pragma once
#include "canopen/emergency.h"
#include "canopen/fault.h"
#include "canopen/master_options.h"
#include "canopen/nmt.h"
#include "canopen/pdo.h"

namespace edgepose {

/// What the master knows of an axis.
struct AxisState {
  int node = 0;
  bool fresh = false;   ///< the state came in answer to the last SYNC
  double position = 0;  ///< [rad]
  double velocity = 0;  ///< [rad/s], with every fourth SYNC
  double torque = 0;    ///< share of the rated torque, with every fourth SYNC
  uint16_t statusword = 0;
  DriveState state = DriveState::kUnknown;
  int missed = 0;  ///< states that did not come, in a row
  uint64_t missed_ever = 0;
  /// False after the drive has booted by itself, or says after a set-up that it is where it cannot have come
  /// to; until confirm_homed().
  bool homed = true;
};

/// Watches one axis: keeps its state and finds what is wrong with it. Faults are values; nothing throws or
/// allocates.
class AxisMonitor {
 public:
  AxisMonitor(const MasterOptions& options, int axis);

  /// The drives have been set up: watch from now on.
  void begin(int64_t now_ns);
  /// A frame of this node.
  Fault take(const CanFrame& frame, int64_t now_ns);
  /// At the end of each cycle's frames. `expects_state`: a SYNC was sent since the last time. `target`: what
  /// the drive was told last [counts]. `is_enabled`: it should be moving.
  Fault judge(int64_t now_ns, bool expects_state, int32_t target, bool is_enabled);

  const AxisState& state() const { return state_; }
  int32_t counts() const { return last_.position; }
  void confirm_homed() { state_.homed = true; }
  /// Whoever watched before has seen the drive boot. Only one whose position was known can have lost it.
  void lose_homing() { state_.homed = state_.homed && !is_placed_; }

 private:
  Fault fault(FaultKind kind, int64_t now_ns, uint32_t found = 0) const;
  Fault take_heartbeat(NmtState state, int64_t now_ns);
  void take_state(const StatePdo& state, int32_t target);
  bool is_where_it_was(double position) const;
  Fault judge_motion(int64_t now_ns, int32_t target) const;

  const MasterOptions& options_;
  AxisState state_;
  StatePdo last_;
  int states_ = 0;   ///< TPDO1 since the last judge()
  int surplus_ = 0;  ///< of TPDO1 over SYNCs
  int same_ = 0;     ///< TPDO1 in a row that said the same
  int32_t target_ = 0, target_when_changed_ = 0;
  bool has_state_ = false, is_placed_ = false;  ///< since begin(); ever
  int64_t heartbeat_ns_ = 0;
};

}  // namespace edgepose
