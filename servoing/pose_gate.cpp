#include "servoing/pose_gate.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "arm/rigid_motion.h"
#include "matcher/option_range.h"
#include "servoing/proper_pose.h"

namespace edgepose {
namespace {

/// One standard deviation in the worst direction.
double worst_of(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

}  // namespace

std::string PoseGateOptions::check() const {
  return option_fault({{"gate.max_age", max_age, 0.01, 10},
                       {"gate.max_future", max_future, 0, 1},
                       {"gate.min_score", min_score, 0, 1},
                       {"gate.max_sigma", max_sigma, 1e-6, 1},
                       {"gate.max_angle_sigma", max_angle_sigma, 1e-6, 1},
                       {"gate.max_jump", max_jump, 1e-5, 1},
                       {"gate.max_turn", max_turn, 1e-5, 3.2}});
}

const char* verdict_name(PoseVerdict verdict) {
  static constexpr std::array<const char*, kPoseVerdicts> kNames = {
      "taken",        "not proper", "from the future", "stale",       "not new",
      "not accepted", "low score",  "uncertain",       "no arm pose", "jumped"};
  return kNames[static_cast<size_t>(verdict)];
}

PoseVerdict PoseGate::judge(const PoseReading& reading, double now, bool arm_known,
                            const std::optional<RigidTransform>& expected) {
  const PoseVerdict result = verdict(reading, now, arm_known, expected);
  ++counts_[static_cast<size_t>(result)];
  if (result == PoseVerdict::kTaken) {
    last_sequence_ = reading.sequence;
    last_capture_ = reading.capture_time;
  }
  return result;
}

PoseVerdict PoseGate::verdict(const PoseReading& reading, double now, bool arm_known,
                              const std::optional<RigidTransform>& expected) const {
  if (!is_proper(reading.camera_T_model) || !reading.covariance.allFinite() ||
      !std::isfinite(reading.score) || !std::isfinite(reading.capture_time))
    return PoseVerdict::kNotProper;
  const double age = now - reading.capture_time;
  if (age < -options_.max_future) return PoseVerdict::kFromFuture;
  if (age > options_.max_age) return PoseVerdict::kStale;
  if (reading.capture_time <= last_capture_ || (last_sequence_ && reading.sequence <= *last_sequence_))
    return PoseVerdict::kNotNew;
  if (!reading.accepted) return PoseVerdict::kNotAccepted;
  if (reading.score < options_.min_score) return PoseVerdict::kLowScore;
  // All zero: the pose was not refined, and how sure it is is not known.
  if (!(reading.covariance.trace() > 0) ||
      worst_of(reading.covariance.bottomRightCorner<3, 3>()) > options_.max_sigma ||
      worst_of(reading.covariance.topLeftCorner<3, 3>()) > options_.max_angle_sigma)
    return PoseVerdict::kUncertain;
  if (!arm_known) return PoseVerdict::kNoArmPose;
  if (expected) {
    const RigidTransform& found = reading.camera_T_model;
    if ((found.translation() - expected->translation()).norm() > options_.max_jump ||
        rotation_vector(expected->linear().transpose() * found.linear()).norm() > options_.max_turn)
      return PoseVerdict::kJumped;
  }
  return PoseVerdict::kTaken;
}

}  // namespace edgepose
