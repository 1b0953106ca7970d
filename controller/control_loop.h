#pragma once
#include <atomic>
#include <functional>
#include <latch>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bus/recorded_bus.h"
#include "common/spsc_ring.h"
#include "controller/arm_controller.h"
#include "controller/cycle_clock.h"
#include "controller/pose_inbox.h"
#include "daemon/real_time.h"

namespace edgepose {

/// Runs an ArmController in real time, on threads of its own of which one at a time works: it never waits for
/// another, poses and requests are left for it, samples and frames it leaves for others.
class ControlLoop {
 public:
  static constexpr size_t kSamples = 1 << 12, kFrames = 1 << 16;  // 20 s; 10 s of a full bus

  /// `make`: makes the controller on the bus that it is given (bus and controller are used by the loop only).
  ControlLoop(std::unique_ptr<CanBus> bus, const std::function<std::unique_ptr<ArmController>(CanBus&)>& make,
              PoseInbox& poses, double cycle, const RealTime& real_time);
  ControlLoop(const ControlLoop&) = delete;
  ControlLoop& operator=(const ControlLoop&) = delete;
  ~ControlLoop();  ///< the arm must be at rest: see finish()

  /// Once. Throws std::system_error if a thread cannot be made. Returns when it runs and the system has said
  /// whether it is real-time.
  void start();
  /// Leaves a request for the loop; false while another is worked on.
  bool post(const ArmRequest& request);
  /// The answer to it, once it is there.
  std::optional<std::string> take_answer();
  /// The controlled stop, in the next cycle.
  void stop() { stop_ = true; }
  /// Stops the arm, waits until it is at rest without power (at most `seconds`), ends the threads.
  void finish(double seconds);

  /// As of the last cycle, or the one before it.
  ControlSample newest() const;
  std::string fault_text() const;       ///< one line; empty without a fault
  std::string real_time_fault() const;  ///< what the system refused; empty if nothing
  const CycleTimes& times() const { return times_; }

  /// For one other thread that writes and publishes.
  SpscRing<ControlSample>& samples() { return samples_; }
  SpscRing<CanFrame>& frames() { return frames_; }

 private:
  /// A thread of the loop: one of those that wake for each cycle.
  void run(std::optional<size_t> processor);
  void work(int64_t now_ns);
  void serve_requests(int64_t now_ns);
  void show(const ControlSample& sample);
  static bool has_power(const ControlSample& sample);

  SpscRing<ControlSample> samples_{kSamples};
  SpscRing<CanFrame> frames_{kFrames};
  RecordedBus bus_;
  std::unique_ptr<ArmController> controller_;
  PoseInbox& poses_;
  const double cycle_;
  const RealTime real_time_;
  const std::vector<size_t> processors_;  ///< a thread on each; empty: one thread, anywhere
  CycleTimes times_;
  CycleClock clock_;
  std::latch started_;
  std::atomic<bool> stop_ = false, ending_ = false, releasing_ = false;
  bool drops_request_ = false;  ///< of whoever works: a stop cancels what waits

  mutable std::mutex mutex_;           // held for moments; the loop only tries
  std::optional<ArmRequest> request_;  // guarded by mutex_, as all below
  bool busy_ = false;
  std::optional<std::string> answer_;
  ControlSample newest_;
  std::string fault_text_, real_time_fault_;
  std::vector<std::thread> threads_;
};

}  // namespace edgepose
