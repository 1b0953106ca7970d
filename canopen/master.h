#pragma once
#include <memory>
#include <vector>

#include "bus/can_bus.h"
#include "canopen/axis_monitor.h"
#include "canopen/cycle_ring.h"
#include "canopen/drive_set_up.h"
#include "canopen/fault.h"
#include "canopen/master_options.h"

namespace edgepose {

enum class MasterPhase : uint8_t {
  kIdle,       ///< says nothing on the bus
  kSettingUp,  ///< checks and configures the drives
  kReady,      ///< SYNC runs, states come, no power on the motors
  kEnabling,   ///< through CiA 402's states, holding each axis where it is
  kEnabled,    ///< set points are followed
  kDisabling,  ///< power off
  kFault,      ///< quick stop; latched until reset()
};
const char* name_of(MasterPhase phase);

enum class EnableResult : uint8_t { kBegun, kNotReady, kHomingRequired };

struct ArmState {
  MasterPhase phase = MasterPhase::kIdle;
  PerAxis<AxisState> axes;
  bool all_fresh = false;  ///< every axis has answered the last SYNC
};

struct MasterCounters {
  uint64_t cycles = 0, syncs = 0;
  uint64_t not_sent = 0;        ///< frames that the bus did not take; they are never sent again
  uint64_t further_faults = 0;  ///< found while one was latched
};

/// CANopen master of a six-axis arm: CiA 402 drives in mode 8 (cyclic synchronous position). Whoever owns it
/// calls receive() and send() every 5 ms, and that is all that happens: no thread, no clock, no waiting. Once
/// it has been made, they neither throw nor, the set-up apart, allocate. One thread.
///
/// A fault makes it tell all drives to stop in the same cycle; the first is kept, with the last 50 cycles,
/// until reset(). This is no certified emergency stop.
class Master {
 public:
  /// `bus` must live longer. Throws std::invalid_argument if an option is out of range.
  Master(CanBus& bus, const MasterOptions& options);
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  /// Resets the drives' communication and sets them up anew, over the next cycles: kSettingUp, then kReady or
  /// a fault. False (nothing happens) unless idle or ready.
  bool set_up(int64_t now_ns);
  /// From kReady over kEnabling to kEnabled.
  EnableResult enable(int64_t now_ns);
  /// Takes the power off; brakes fall, so the arm should be at rest. False unless enabled.
  bool disable(int64_t now_ns);
  /// A fault of its own kind: quick stop, latched.
  void stop(int64_t now_ns);
  /// In a fault: power off, where else the drives would hold the axes; to be said when the arm is at rest.
  void release() { released_ = true; }
  /// Forgets the fault and sets the drives up anew. False unless in kFault.
  bool reset(int64_t now_ns);
  /// The axis knows its position again after its drive has booted.
  void confirm_homed(int axis);

  /// The first half of a cycle: takes what has come and judges it. The state is that of the last SYNC.
  const ArmState& receive(int64_t now_ns);
  /// The second half: sends set points and SYNC. `set_points` [rad] are followed in kEnabled only, where the
  /// first must be where the arm is: else they are ignored, and each axis told to stay.
  const ArmState& send(int64_t now_ns, const PerAxis<double>& set_points);
  /// Both at once, for set points that do not depend on the state.
  const ArmState& cycle(int64_t now_ns, const PerAxis<double>& set_points) {
    receive(now_ns);
    return send(now_ns, set_points);
  }

  const ArmState& state() const { return state_; }
  const Fault& fault() const { return fault_; }
  /// One line; empty without a fault.
  std::string fault_text() const;
  std::vector<CycleRecord> last_cycles() const { return ring_.all(); }
  const MasterCounters& counters() const { return counters_; }

 private:
  void take_frames(int64_t now_ns);
  int8_t axis_of(const CanFrame& frame) const;  ///< -1: of no drive
  void dispatch(const CanFrame& frame, int64_t now_ns);
  void take_event(BusEvent event, int64_t now_ns);
  void latch(const Fault& fault);
  void latch(FaultKind kind, int64_t now_ns, uint32_t found = 0);
  void begin_set_up(int64_t now_ns);
  void drop_old_frames(int64_t now_ns);
  void take_unwatched(const CanFrame& frame);
  void lose_homing(int axis);
  void continue_set_up(int64_t now_ns);
  void judge(int64_t now_ns);
  void take_set_points(const PerAxis<double>& set_points, int64_t now_ns);
  void hold();
  void transit(int64_t now_ns);
  uint16_t controlword_for(size_t axis);
  uint64_t waiting_syncs();
  void produce(int64_t now_ns);
  bool put(const CanFrame& frame);
  void remember(int64_t now_ns);

  CanBus& bus_;
  const MasterOptions options_;
  std::vector<std::unique_ptr<DriveSetUp>> set_ups_;
  std::vector<AxisMonitor> monitors_;
  std::array<int8_t, 128> axis_of_node_;  ///< -1: none
  ArmState state_;
  Fault fault_;
  std::string set_up_error_;
  PerAxis<int32_t> targets_{};  ///< [counts]
  PerAxis<uint16_t> controlwords_{};
  PerAxis<DriveState> last_states_{};
  PerAxis<int64_t> since_ns_{};     ///< when each axis' state changed, while enabling or disabling
  PerAxis<int> cycles_in_phase_{};  ///< for fault resets and stops, counted from the phase's beginning
  bool released_ = false;
  bool communicating_ = false;                      ///< drives are operational: SYNC runs
  bool was_latched_ = false, was_enabled_ = false;  ///< when this cycle began
  bool sync_sent_ = false, took_frames_ = true, is_down_ = false;
  int no_room_ = 0, flooded_ = 0;
  uint64_t lost_syncs_ = 0;  ///< that were never confirmed, and never will be
  int64_t last_cycle_ns_ = 0, next_heartbeat_ns_ = 0;
  CycleRing ring_;
  MasterCounters counters_;
};

}  // namespace edgepose
