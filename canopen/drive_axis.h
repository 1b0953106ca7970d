#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "canopen/cia402.h"
#include "canopen/drive_motion.h"
#include "canopen/drive_options.h"
#include "canopen/emergency.h"
#include "canopen/object_dictionary.h"

namespace edgepose {

/// The power side of a simulated drive: CiA 402's state machine over the motion, with limits and errors as
/// its objects say. Knows nothing of CAN.
class DriveAxis {
 public:
  DriveAxis(ObjectDictionary& objects, const DriveOptions& options);

  /// Acts on controlword, mode and target as they stand in the objects.
  void apply();
  void advance(double duration);
  /// Writes statusword, position, velocity and following error to the objects.
  void refresh();

  /// The connection was lost: what 6007 says.
  void lose_connection(uint16_t code);
  /// An error of the drive itself: comes to rest, then is in fault.
  void fail(uint16_t code);
  /// Power off and on again: nothing pending, switch on disabled.
  void restart();
  /// Power off; a fault stays.
  void cut_power();
  /// An EMCY that is to be sent, oldest first.
  std::optional<Emergency> take_emergency();

  void set_mobility(double share) { motion_.set_mobility(share); }
  void ignore_controlword(bool ignore) { deaf_ = ignore; }
  DriveState state() const { return state_; }
  const DriveMotion& motion() const { return motion_; }

 private:
  void enter(DriveState state);
  void report(uint16_t code, uint8_t error_register);
  void check_following(double duration);
  double radians(ObjectId id) const;

  ObjectDictionary& objects_;
  const DriveOptions& options_;
  DriveMotion motion_;
  DriveState state_ = DriveState::kSwitchOnDisabled;
  uint16_t previous_word_ = 0;
  bool deaf_ = false, limited_ = false;
  double beyond_window_ = 0;  ///< [s] for which the following error has been beyond its window
  static constexpr size_t kMaxWaiting = 4;
  std::array<Emergency, kMaxWaiting> waiting_{};
  size_t waiting_count_ = 0;
};

}  // namespace edgepose
