#include "matcher/self_match.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace edgepose {
namespace {

constexpr size_t kTestPoints = 600;
constexpr size_t kCoarsePoints = 200;     // of the first steps, which most motions fail
constexpr float kMeanTolerance = 0.005f;  // [d] mean distance of the moved surface from itself
constexpr float kTrifle = 0.006f;         // [d]
constexpr float kOutlier = 0.02f;         // [d] farther off is not the same surface ...
constexpr float kMaxOutliers = 0.01f;     // ... and this share of it may be
constexpr float kReach = 0.036f;      // [d] samples are 0.018 d apart: within twice that is the nearest one
constexpr size_t kThinned = 4;        // the first quarter of the samples is spread half as densely
constexpr double kLargestTurn = 0.4;  // [rad] in one step; beyond it the step is no approximation
constexpr int kCoarseSteps = 3, kSteps = 15;
// Holds the turns that the surface does not (a cylinder's about its axis), which noise alone would drive.
constexpr double kDamping = 1e-4;

}  // namespace

bool SelfMatch::Distance::is_match() const { return mean < kMeanTolerance && outliers <= kMaxOutliers; }

SelfMatch::SelfMatch(const std::vector<OrientedPoint>& samples, const std::vector<OrientedPoint>& crowd,
                     float diameter)
    : samples_(samples),
      diameter_(diameter),
      centroid_(Eigen::Vector3d::Zero()),
      inertia_(Eigen::Matrix3d::Zero()),
      coarse_(samples, (samples.size() + kThinned - 1) / kThinned, 2 * kReach * diameter),
      fine_(samples, samples.size(), kReach * diameter) {
  const double count = static_cast<double>(crowd.size());
  for (const auto& p : crowd) centroid_ += p.position.cast<double>() / count;
  for (const auto& p : crowd) {
    const Eigen::Vector3d q = (p.position.cast<double>() - centroid_) / diameter;
    inertia_ += q * q.transpose() / count;
  }
}

SelfMatch::Distance SelfMatch::distance(const RigidTransform& motion) const {
  const Eigen::Matrix3f rotation = motion.linear().cast<float>();
  const Eigen::Vector3f translation = motion.translation().cast<float>();
  const size_t count = std::min(kTestPoints, samples_.size());
  float sum = 0, off_count = 0, outliers = 0;
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = rotation * samples_[i].position + translation;
    const OrientedPoint* nearest = fine_.find(p, rotation * samples_[i].normal);
    const float off = nearest ? std::abs(nearest->normal.dot(nearest->position - p)) / diameter_ : 1;
    sum += std::min(off, kOutlier);
    off_count += off > kTrifle;
    outliers += off > kOutlier;
  }
  const float all = static_cast<float>(count);
  return {sum / all, off_count / all, outliers / all};
}

bool SelfMatch::refine(RigidTransform& motion) const {
  double moved = 0;
  for (int i = 0; i < kCoarseSteps; ++i)
    if (!step(coarse_, std::min(kCoarsePoints, samples_.size()), motion, moved)) return false;
  for (int i = kCoarseSteps; i < kSteps; ++i) {
    if (!step(fine_, std::min(kTestPoints, samples_.size()), motion, moved)) return false;
    if (moved < 1e-4) break;
  }
  return true;
}

/// One step of least squares, in diameters about the centroid. `moved`: its length [rad, d].
bool SelfMatch::step(const NearestSurface& nearest_surface, size_t count, RigidTransform& motion,
                     double& moved) const {
  Eigen::Matrix<double, 6, 6> a =
      Eigen::Matrix<double, 6, 6>::Identity() * (kDamping * static_cast<double>(count));
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  const Eigen::Matrix3f rotation = motion.linear().cast<float>();
  const Eigen::Vector3f translation = motion.translation().cast<float>();
  size_t missed = 0;
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = rotation * samples_[i].position + translation;
    const OrientedPoint* nearest = nearest_surface.find(p, rotation * samples_[i].normal);
    if (!nearest) {
      if (++missed > count / 5) return false;
      continue;
    }
    const Eigen::Vector3d n = nearest->normal.cast<double>();
    Eigen::Matrix<double, 6, 1> j;
    j << ((p.cast<double>() - centroid_) / diameter_).cross(n), n;
    a += j * j.transpose();
    b += j * static_cast<double>(nearest->normal.dot(nearest->position - p) / diameter_);
  }
  const Eigen::Matrix<double, 6, 1> x = a.ldlt().solve(b);
  const Eigen::Vector3d w = x.head<3>();
  if (!x.allFinite() || w.norm() > kLargestTurn) return false;
  RigidTransform correction = RigidTransform::Identity();
  if (w.norm() > 1e-12) correction.linear() = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
  correction.translation() = centroid_ + diameter_ * x.tail<3>() - correction.linear() * centroid_;
  motion = correction * motion;
  moved = x.norm();
  return true;
}

}  // namespace edgepose
