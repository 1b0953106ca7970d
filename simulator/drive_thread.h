#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "simulator/simulated_arm.h"
#include "simulator/simulated_bus.h"
#include "simulator/truth_log.h"

namespace edgepose {

/// How late the drives were served.
struct DriveTimes {
  uint64_t steps = 0;
  int64_t worst_late_ns = 0;  ///< of a millisecond's deadline
};

/// The simulated drives in real time, on a thread of their own: served as soon as the bus has input and every
/// millisecond. Safe from any thread.
class DriveThread {
 public:
  /// Opens the bus and starts. `log` may be null; `bus` and `log` must live longer. Throws InputError if the
  /// bus cannot be opened or an option is wrong.
  DriveThread(SimulatedBus& bus, const SimulatedArmOptions& options, TruthLog* log);
  DriveThread(const DriveThread&) = delete;
  DriveThread& operator=(const DriveThread&) = delete;
  ~DriveThread();

  TruthSample truth() const;  ///< of the last step
  DriveTimes times() const;
  /// Does something with the arm between two steps.
  void with(const std::function<void(SimulatedArm&)>& work);

 private:
  class Port;
  void run();
  void step(int64_t now_ns);

  SimulatedBus& bus_;
  TruthLog* const log_;
  std::unique_ptr<Port> port_;
  mutable std::mutex mutex_;
  std::unique_ptr<SimulatedArm> arm_;  // guarded by mutex_, as the next two
  TruthSample truth_;
  DriveTimes times_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace edgepose
