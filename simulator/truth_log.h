#pragma once
#include <array>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "canopen/cia402.h"
#include "edgepose_lcm/arm_truth_t.hpp"
#include "simulator/simulated_arm.h"
#include "simulator/work_cell.h"

namespace edgepose {

inline constexpr const char* kTruthChannel = "EDGEPOSE_TRUTH";

/// How the arm truly is at one instant.
struct TruthSample {
  int64_t time_ns = 0;                                                         ///< steady clock
  JointVector position = JointVector::Zero(), velocity = JointVector::Zero();  ///< [rad], [rad/s]
  std::array<DriveState, kJoints> states{};
};
TruthSample truth_of(const SimulatedArm& arm, int64_t time_ns);

/// `utime`: [us] since 1970, UTC, of the same instant.
edgepose_lcm::arm_truth_t truth_message(const WorkCell& cell, const DrillTarget& target,
                                        const TruthSample& sample, int64_t utime);

/// Writes the truth as CSV, one line a sample: time_ns, q1..q6 [rad], v1..v6 [rad/s], s1..s6 (DriveState's
/// numbers), along_m, across_m, angle_rad, tip_speed (of positioning_error). A thread of its own computes and
/// writes; add() never waits for the disk.
class TruthLog {
 public:
  /// `cell` must live longer. Throws InputError if the file cannot be made; one of the name is replaced.
  TruthLog(const std::filesystem::path& path, const WorkCell& cell, const DrillTarget& target);
  TruthLog(const TruthLog&) = delete;
  TruthLog& operator=(const TruthLog&) = delete;
  ~TruthLog();  ///< writes what waits

  /// To be called once a millisecond, or less. If more than a minute's worth waits, the sample is lost and
  /// counted.
  void add(const TruthSample& sample);
  uint64_t lost() const;  ///< for which there was no room: in memory or on the disk

 private:
  void run();
  void write(const TruthSample& sample);

  const WorkCell& cell_;
  const DrillTarget target_;
  FILE* file_ = nullptr;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<TruthSample> waiting_;  // guarded by mutex_, as the next two
  uint64_t lost_ = 0;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace edgepose
