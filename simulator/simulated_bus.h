#pragma once
#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "bus/unix_bus_hub.h"

namespace edgepose {

/// The bus that the simulated drives are on, and what may befall it. If it is a Unix bus, it is offered from
/// here, by a thread of its own. Safe from any thread.
class SimulatedBus {
 public:
  /// `name`: as open_bus() takes it. Throws InputError if the bus cannot be offered.
  explicit SimulatedBus(std::string name);
  SimulatedBus(const SimulatedBus&) = delete;
  SimulatedBus& operator=(const SimulatedBus&) = delete;
  ~SimulatedBus();

  const std::string& name() const { return name_; }
  /// Puts frames of identifier 1 on it as fast as it takes them, for so long. A second call while it lasts
  /// does nothing and says false.
  bool flood(double seconds);
  bool is_flooded() const { return flooding_; }
  uint64_t flood_frames() const { return flood_frames_; }
  /// Everybody's controller reports bus-off: an error frame, as SocketCAN tells it. Throws InputError if it
  /// cannot be sent.
  void report_bus_off();
  /// The bus ceases to be, for good. False if it is not ours (a CAN interface).
  bool take_down();
  bool is_up() const { return up_; }
  size_t members() const { return members_; }  ///< of a Unix bus, the drives included

 private:
  void serve();

  const std::string name_;
  std::unique_ptr<UnixBusHub> hub_;
  std::atomic<bool> ending_ = false, up_ = true, flooding_ = false;
  std::atomic<size_t> members_ = 0;
  std::atomic<uint64_t> flood_frames_ = 0;
  std::mutex mutex_;  // of the threads
  std::thread server_, flooder_;
};

}  // namespace edgepose
