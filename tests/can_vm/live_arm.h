#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "bus/can_bus.h"
#include "canopen/drive.h"
#include "canopen/master.h"

namespace edgepose {

/// A master and six drives on vcan0 in real time, each with a socket of its own. The drives' side records the
/// bus: what the master sends with the kernel's times. The master is run by the caller's thread.
class LiveArm {
 public:
  /// `trace`: where the capture is written.
  explicit LiveArm(const std::filesystem::path& trace, const MasterOptions& options = {});
  ~LiveArm();  ///< ends the threads; then the capture is whole

  /// Cycles of 5 ms until `done` says so, at most `limit` [s]; `velocity` [rad/s] moves the set points of all
  /// axes. True if it was done.
  bool run_until(const std::function<bool()>& done, double limit, double velocity = 0);
  /// Until the master is in `phase`, or in fault.
  bool run_until(MasterPhase phase, double limit, double velocity = 0);
  void run_for(double seconds, double velocity = 0) {
    run_until([] { return false; }, seconds, velocity);
  }
  /// From nothing to enabled, with the set points where the arm is.
  void enable();

  Master& master() { return *master_; }
  CanBus& master_bus() { return *master_bus_; }
  void provoke(int drive, Provocation kind);
  /// The simulated drives' truth.
  PerAxis<double> positions();
  PerAxis<DriveState> states();
  bool rests();  ///< no axis moves
  int64_t worst_lateness_ns() const { return worst_lateness_ns_; }
  /// All frames that have come from the master so far, with the kernel's times.
  std::vector<CanFrame> heard();

 private:
  void run_drives();

  std::atomic<bool> ends_{false};
  std::mutex lock_;  ///< over the drives and what they have heard
  std::vector<CanFrame> heard_;
  std::unique_ptr<CanBus> master_bus_, drives_bus_;
  std::unique_ptr<Master> master_;
  std::vector<std::unique_ptr<Drive>> drives_;
  PerAxis<double> set_points_{};
  int64_t next_ns_ = 0, worst_lateness_ns_ = 0;
  std::thread drives_thread_;
};

}  // namespace edgepose
