#pragma once
#include <array>

#include "bus/can_bus.h"
#include "canopen/deadline.h"
#include "canopen/drive_axis.h"
#include "canopen/nmt.h"
#include "canopen/sdo_server.h"

namespace edgepose {

/// What can be wrong with a drive. Each lasts until it is taken back, but for the first two, which happen
/// once.
enum class Provocation : uint8_t {
  kEmergency,          ///< too hot: EMCY 0x4210, fault reaction
  kReboot,             ///< loses its supply for a moment: boot-up
  kJam,                ///< the axis is blocked
  kDrag,               ///< the axis hardly moves
  kFrozenState,        ///< TPDO1 says the same again and again
  kIgnoresController,  ///< the state machine does not act on controlwords
  kNoHeartbeat,
  kNoTpdo,
  kNoSdo,
  kDead,  ///< says and hears nothing; the brake falls
  kCount,
};

/// A simulated CiA 402 drive in mode 8, a node on a bus: its own objects, NMT, SDO, PDOs with SYNC, EMCY,
/// heartbeat; watches over SYNC, RPDOs (1400:05) and the master's heartbeat (1016), and stops by itself. One
/// thread.
class Drive {
 public:
  /// `bus` may be shared by several drives: then call take() and advance(), not step(). Must live longer.
  Drive(CanBus& bus, const DriveOptions& options, int64_t now_ns);
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;

  /// Takes what the bus has received, then advances.
  void step(int64_t now_ns);
  void take(const CanFrame& frame, int64_t now_ns);
  /// Moves the axis up to now, in steps of at most 1 ms, at most 2 s (a program that was stopped does not
  /// catch up on more); sends what is due.
  void advance(int64_t now_ns);

  void provoke(Provocation kind, bool on = true);

  /// The truth [rad], [rad/s].
  double position() const { return axis_.motion().position(); }
  double velocity() const { return axis_.motion().velocity(); }
  DriveState state() const { return axis_.state(); }
  NmtState nmt() const { return nmt_; }
  int node() const { return options_.node; }
  const ObjectDictionary& objects() const { return objects_; }

 private:
  bool is(Provocation kind) const { return provoked_[static_cast<size_t>(kind)]; }
  void boot();
  void power_cycle();
  void obey(const NmtMessage& message);
  void synchronise(int64_t now_ns);
  void send_tpdo(int number, int64_t now_ns);
  void watch(int64_t now_ns);
  void lose(uint16_t code);
  void say(CanFrame frame);

  CanBus& bus_;
  const DriveOptions options_;
  ObjectDictionary objects_;
  DriveAxis axis_;
  SdoServer sdo_;
  NmtState nmt_ = NmtState::kBootUp;
  std::array<bool, static_cast<size_t>(Provocation::kCount)> provoked_{};
  CanFrame rpdo_, last_tpdo1_;
  bool rpdo_waits_ = false;
  uint64_t syncs_ = 0;
  Deadline rpdo_deadline_, sync_deadline_, master_deadline_;
  int64_t time_ns_, next_heartbeat_ns_ = 0;
};

}  // namespace edgepose
