#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "messaging/lcm_publisher.h"
#include "simulator/cell_camera.h"
#include "simulator/drive_thread.h"
#include "simulator/periodic_thread.h"
#include "simulator/pose_source.h"
#include "simulator/simulation_options.h"
#include "simulator/told.h"

namespace edgepose {

struct PublisherCounts {
  uint64_t messages = 0, failed = 0;  ///< sent, and refused by the system
  double capture_seconds = 0;         ///< [s] that the last image took
};

/// What the simulator says over LCM: depth frames or poses at their rate, the truth at 20 Hz, each from a
/// thread of its own, so that neither holds up the drives. Safe from any thread.
class SimPublisher {
 public:
  /// `cell` and `drives` must live longer. Throws InputError if there is no route, no key, or an option is
  /// wrong.
  SimPublisher(const WorkCell& cell, const DrillTarget& target, const ToldEquipment& told,
               const SimulationOptions& options, const DriveThread& drives);

  void set_wrong(PoseWrong wrong, int count);
  std::string wrong() const;  ///< name of what is wrong with the poses now
  PublisherCounts counts() const;

 private:
  void publish_depth();
  void publish_poses();
  void publish_truth();
  void send(const std::string& channel, std::span<const std::byte> bytes);

  const WorkCell& cell_;
  const DrillTarget target_;
  const DriveThread& drives_;
  LcmPublisher lcm_;
  std::optional<CellCamera> camera_;  // of its thread only
  mutable std::mutex mutex_;
  std::optional<PoseSource> poses_;  // guarded by mutex_, as the next
  PublisherCounts counts_;
  std::unique_ptr<PeriodicThread> frames_, truth_;  // last: end first
};

}  // namespace edgepose
