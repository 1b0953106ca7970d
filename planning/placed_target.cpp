#include "planning/placed_target.h"

#include <algorithm>
#include <cmath>

#include "planning/worst_sigma.h"

namespace edgepose {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// A perturbation (w, t) about `centre` moves `point` by w x (point - centre) + t.
double sigma_across(const Eigen::Vector3d& point, const Eigen::Vector3d& axis, const Eigen::Vector3d& centre,
                    const Matrix6d& covariance) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << -cross_matrix(point - centre), Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  return worst_sigma(across * jacobian * covariance * jacobian.transpose() * across);
}

PlacedTarget place(const DrillTarget& planned, const Detection& detection,
                   const Eigen::Vector3d& model_centre) {
  const RigidTransform& pose = detection.camera_T_model;
  PlacedTarget placed{planned};
  DrillTarget& target = placed.target;
  target.entry = pose * planned.entry;
  target.axis = pose.linear() * planned.axis;
  const Eigen::Vector3d centre = pose * model_centre;
  const Matrix6d& covariance = detection.covariance;
  placed.entry_sigma = sigma_across(target.entry, target.axis, centre, covariance);
  placed.bottom_sigma =
      sigma_across(target.entry + target.depth * target.axis, target.axis, centre, covariance);
  const Eigen::Matrix3d turn = cross_matrix(target.axis);
  placed.angle_sigma = worst_sigma(turn * covariance.topLeftCorner<3, 3>() * turn.transpose());
  placed.certain = covariance.allFinite() && covariance.trace() > 0 &&
                   2 * std::max(placed.entry_sigma, placed.bottom_sigma) <= target.position_tolerance &&
                   2 * placed.angle_sigma <= target.angle_tolerance;
  return placed;
}

}  // namespace

std::vector<PlacedTarget> place_targets(const DrillPlan& plan, const std::vector<Detection>& detections,
                                        const Eigen::Vector3d& model_centre) {
  std::vector<PlacedTarget> targets;
  for (size_t i = 0; i < detections.size(); ++i) {
    if (!detections[i].accepted) continue;
    for (const DrillTarget& target : plan.targets) {
      targets.push_back(place(target, detections[i], model_centre));
      targets.back().instance = i;
    }
  }
  return targets;
}

}  // namespace edgepose
