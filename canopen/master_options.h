#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "canopen/drive_options.h"

namespace edgepose {

inline constexpr int kAxes = 6;
template <class Value>
using PerAxis = std::array<Value, kAxes>;

/// What the master expects of the drives, what it tells them, and how patient it is. Times in [s]. Defaults:
/// the AUBO i5's limits.
struct MasterOptions {
  PerAxis<int> nodes{1, 2, 3, 4, 5, 6};
  int master_node = 127;        ///< whose heartbeat the drives watch
  DriveIdentity identity;       ///< vendor and product are compared (1018)
  PerAxis<uint32_t> serials{};  ///< 0: any
  JointScale scale;

  double cycle = 0.005;                                                    ///< of SYNC; whole milliseconds
  PerAxis<double> min_position{-3.04, -3.04, -3.04, -3.04, -3.04, -3.04};  ///< [rad]
  PerAxis<double> max_position{3.04, 3.04, 3.04, 3.04, 3.04, 3.04};
  PerAxis<double> max_velocity{3.14, 3.14, 3.14, 2.6, 2.6, 2.6};  ///< [rad/s]
  double quick_stop_deceleration = 15;                            ///< [rad/s^2]
  double following_window = 0.05;  ///< [rad] in the drive, between what it demands of itself and its position
  double following_timeout = 0.010;       ///< after which the drive is in fault
  double master_following_window = 0.10;  ///< [rad] between target and position, as the master sees them

  double drive_heartbeat = 0.040, drive_heartbeat_timeout = 0.100;
  double master_heartbeat = 0.020, master_heartbeat_timeout = 0.060;
  /// The drive stops if no RPDO has come for this long (1400:05): three may be lost, and 2 ms late.
  double rpdo_timeout = 0.022;
  int max_missed = 4;  ///< states in a row that an axis may fail to send; one more is a fault
  /// Cycles in a row in which the bus takes no frame, until that is a fault; or more than every third, for
  /// long.
  int max_no_room = 3;
  /// SYNCs that may still wait in the interface's queue when a cycle begins. If more do, nothing is put
  /// behind them, where it would be stale: a cycle without room. Known only of a bus that was asked to
  /// confirm them (open_bus(name, received_ids(), {cob_id::kSync})).
  int max_waiting_syncs = 1;
  int max_frames_a_cycle = 512;  ///< more than these wait: the bus is flooded
  int stuck_cycles = 3;          ///< states in a row that are the same although the target moves
  double stuck_motion = 0.002;   ///< [rad] by which the target must have moved for that
  int stop_cycles = 4;           ///< after which an axis that is told to stop must be seen to

  double boot_timeout = 2.0;        ///< from the reset to boot-up
  double settle = 0.050;            ///< after it: a second node of the same number boots as well
  double sdo_timeout = 0.3;         ///< for one object
  double start_timeout = 1.0;       ///< from NMT start to the heartbeat that says operational
  double transition_timeout = 0.5;  ///< for each step of the CiA 402 state machine

  /// Throws std::invalid_argument that names the field and what it may be.
  void check() const;
  /// All that the master wants to hear, to be filtered for by the bus (bus/open_bus.h).
  std::vector<uint16_t> received_ids() const;
};

}  // namespace edgepose
