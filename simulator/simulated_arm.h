#pragma once
#include <array>
#include <memory>
#include <optional>

#include "arm/types.h"
#include "bus/can_bus.h"
#include "canopen/drive.h"

namespace edgepose {

/// The six drives as they are before anybody speaks to them.
struct SimulatedArmOptions {
  JointVector start = JointVector::Zero();          ///< [rad]
  JointScale scale;                                 ///< encoder steps a turn
  double lag = 0.004;                               ///< [s] with which axes follow their demand
  JointVector sag = JointVector::Zero();            ///< [rad] that axes rest beside it
  std::array<DriveIdentity, kJoints> identities{};  ///< object 1018 of each
  int duplicate_axis = -1;  ///< 0 to 5: a second drive with this one's node number is on the bus; -1: none
  int absent_axis = -1;     ///< 0 to 5: this drive is not there (its axis stays where it is); -1: none

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// Six simulated drives, nodes 1 to 6, on one port of a bus, and the arm that they move. Time comes in with
/// each step. One thread.
class SimulatedArm {
 public:
  /// `bus` must live longer. Throws InputError if an option is wrong.
  SimulatedArm(CanBus& bus, const SimulatedArmOptions& options, int64_t now_ns);

  /// Takes what the bus has received, then moves the drives up to now. Call it at least every millisecond,
  /// and as soon as the bus has input, so that SYNC is answered at once. True if the bus has ended (kDown).
  bool step(int64_t now_ns);

  JointVector position() const;  ///< [rad] the truth
  JointVector velocity() const;  ///< [rad/s]
  Drive& drive(int axis) { return *drives_.at(static_cast<size_t>(axis)); }
  const Drive& drive(int axis) const { return *drives_.at(static_cast<size_t>(axis)); }
  /// `axis`: 0 to 5.
  void provoke(int axis, Provocation kind, bool on = true) { drive(axis).provoke(kind, on); }
  /// The drives do not see the next `count` SYNCs.
  void drop_syncs(int count) { syncs_to_drop_ = count; }

  uint64_t frames() const { return frames_; }  ///< that were taken from the bus

 private:
  void take(const CanFrame& frame, int64_t now_ns);

  CanBus& bus_;
  std::array<std::unique_ptr<Drive>, kJoints> drives_;
  std::unique_ptr<Drive> duplicate_;
  int syncs_to_drop_ = 0;
  uint64_t frames_ = 0;
};

/// "emergency", "reboot", "jam", "drag", "frozen_state", "ignores_controller", "no_heartbeat", "no_tpdo",
/// "no_sdo", "dead"; nothing for another word.
std::optional<Provocation> provocation_named(const std::string& name);
/// All of these names, with commas.
std::string provocation_names();

}  // namespace edgepose
