#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "arm/types.h"

namespace edgepose {

/// One answer of the pose service about the model that is followed.
struct PoseReading {
  int64_t sequence = 0;     ///< of the frame; grows
  double capture_time = 0;  ///< [s] when the frame was taken, on the controller's steady clock
  bool accepted = false;    ///< the service's own verdict
  double score = 0;         ///< 0 to 1
  /// Of (rotation vector [rad], translation [m]) about the model's centre, camera frame
  /// (docs/frames_and_units.md).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  RigidTransform camera_T_model = RigidTransform::Identity();
};

struct PoseGateOptions {
  double max_age = 0.4;           ///< [s] since the capture: what the service takes for a frame, and some
  double max_future = 0.01;       ///< [s] a capture may lie ahead of our clock: no more than clocks differ
  double min_score = 0.66;        ///< 0 to 1; more refuses more under occlusion
  double max_sigma = 0.002;       ///< [m] one standard deviation of the position, worst direction
  double max_angle_sigma = 0.02;  ///< [rad] one standard deviation of the rotation, worst direction
  double max_jump = 0.02;  ///< [m] of the model's origin from where it is expected: patients breathe. A model
                           ///< that stays elsewhere needs reset and arm
  double max_turn = 0.15;  ///< [rad] from how it is expected

  std::string check() const;
};

/// What became of a pose. In the order in which it is asked.
enum class PoseVerdict {
  kTaken,
  kNotProper,    ///< not finite, no rotation, far away, a covariance that is none
  kFromFuture,   ///< captured after now
  kStale,        ///< captured too long ago
  kNotNew,       ///< sequence or capture time not after the last one taken
  kNotAccepted,  ///< by the service
  kLowScore,
  kUncertain,  ///< its covariance is too large, or not known
  kNoArmPose,  ///< where the arm was at the capture is not known
  kJumped,     ///< far from where the model is expected
};
inline constexpr size_t kPoseVerdicts = 10;
const char* verdict_name(PoseVerdict verdict);  ///< "taken", "not proper", ...

/// Decides which poses the arm may follow, and counts. Not safe for use by several threads at once.
class PoseGate {
 public:
  explicit PoseGate(const PoseGateOptions& options) : options_(options) {}

  /// `expected`: camera_T_model at the capture, from earlier poses and the arm's motion; none for the first.
  /// `arm_known`: the arm's position at the capture is.
  PoseVerdict judge(const PoseReading& reading, double now, bool arm_known,
                    const std::optional<RigidTransform>& expected);

  /// From now on only the capture time says what is new.
  void forget_sequence() { last_sequence_.reset(); }

  int64_t count(PoseVerdict verdict) const { return counts_[static_cast<size_t>(verdict)]; }

 private:
  PoseVerdict verdict(const PoseReading& reading, double now, bool arm_known,
                      const std::optional<RigidTransform>& expected) const;

  PoseGateOptions options_;
  std::array<int64_t, kPoseVerdicts> counts_{};
  std::optional<int64_t> last_sequence_;
  double last_capture_ = -1e300;
};

}  // namespace edgepose
