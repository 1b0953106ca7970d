#include "matcher/symmetry.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "matcher/clustering.h"
#include "matcher/point_grid.h"

namespace edgepose {
namespace {

constexpr size_t kTestPoints = 600;
constexpr float kMeanTolerance = 0.005f;  // [d] mean distance of the moved surface from itself
constexpr float kOutlier = 0.02f;         // [d] farther off is not the same surface ...
constexpr float kMaxOutliers = 0.01f;     // ... and this share of it may be
constexpr double kEqualInertia = 0.04;    // relative difference of moments that count as equal

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Measures how well a motion maps the surface onto itself.
class SelfMatch {
 public:
  SelfMatch(const std::vector<OrientedPoint>& surface, float diameter)
      : surface_(surface), diameter_(diameter), grid_(0.06f * diameter) {
    for (uint32_t i = 0; i < surface.size(); ++i) grid_.add(surface[i].position, i);
  }

  /// Refines the motion point to plane; true if it is a symmetry then.
  bool accept(RigidTransform& motion) const {
    for (int i = 0; i < 4; ++i)
      if (!step(motion)) return false;
    float sum = 0, outliers = 0;
    const size_t count = std::min(kTestPoints, surface_.size());
    for (size_t i = 0; i < count; ++i) {
      const auto [distance, nearest] = closest(motion, surface_[i]);
      sum += std::min(distance, kOutlier * diameter_);
      outliers += distance > kOutlier * diameter_;
    }
    return sum < kMeanTolerance * diameter_ * static_cast<float>(count) &&
           outliers <= kMaxOutliers * static_cast<float>(count);
  }

 private:
  /// Distance along the normal from the moved point to the nearest surface that faces the same way.
  std::pair<float, const OrientedPoint*> closest(const RigidTransform& motion,
                                                 const OrientedPoint& point) const {
    const Eigen::Vector3f p = (motion * point.position.cast<double>()).cast<float>();
    const Eigen::Vector3f n = (motion.linear() * point.normal.cast<double>()).cast<float>();
    const OrientedPoint* best = nullptr;
    float best_squared = std::numeric_limits<float>::infinity();
    grid_.visit_near(p, [&](uint32_t k) {
      const float squared = (surface_[k].position - p).squaredNorm();
      if (squared < best_squared && surface_[k].normal.dot(n) > 0.5f)
        best_squared = squared, best = &surface_[k];
      return true;
    });
    // Samples are 0.018 d apart: farther than twice that there is no surface beside the point.
    if (!best || best_squared > 0.036f * 0.036f * diameter_ * diameter_) return {diameter_, nullptr};
    return {std::abs(best->normal.dot(best->position - p)), best};
  }

  bool step(RigidTransform& motion) const {
    Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Identity() * 1e-6;
    Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
    size_t used = 0;
    const size_t count = std::min(kTestPoints, surface_.size());
    for (size_t i = 0; i < count; ++i) {
      const auto [distance, nearest] = closest(motion, surface_[i]);
      if (!nearest) continue;
      const Eigen::Vector3d p = motion * surface_[i].position.cast<double>(),
                            n = nearest->normal.cast<double>();
      Eigen::Matrix<double, 6, 1> j;
      j << p.cross(n), n;
      a += j * j.transpose();
      b += j * n.dot(nearest->position.cast<double>() - p);
      ++used;
    }
    if (used < count * 8 / 10) return false;
    const Eigen::Matrix<double, 6, 1> x = a.ldlt().solve(b);
    const Eigen::Vector3d w = x.head<3>();
    if (!x.allFinite() || w.norm() > 0.2) return false;
    RigidTransform correction = RigidTransform::Identity();
    if (w.norm() > 1e-12)
      correction.linear() = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
    correction.translation() = x.tail<3>();
    motion = correction * motion;
    return true;
  }

  const std::vector<OrientedPoint>& surface_;
  float diameter_;
  PointGrid grid_;
};

RigidTransform turn_about(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis, double angle) {
  RigidTransform t = RigidTransform::Identity();
  t.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  t.translation() = centre - t.linear() * centre;
  return t;
}

void add_if_new(const RigidTransform& motion, std::vector<RigidTransform>& found) {
  if (Eigen::AngleAxisd(motion.linear()).angle() < radians(4)) return;
  for (const RigidTransform& known : found)
    if (Eigen::AngleAxisd(known.linear().transpose() * motion.linear()).angle() < radians(4)) return;
  found.push_back(motion);
}

/// Tries the turns of 2 to 24 parts about an axis; true if any angle will do (a surface of revolution).
bool try_axis(const SelfMatch& self, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
              std::vector<RigidTransform>& found) {
  bool any_angle = true;
  for (double degrees : {37.0, 71.0, 113.0, 157.0}) {
    RigidTransform turn = turn_about(centre, axis, radians(degrees));
    any_angle = any_angle && self.accept(turn) &&
                std::abs(Eigen::AngleAxisd(turn.linear()).angle() - radians(degrees)) < radians(5);
    if (!any_angle) break;
  }
  if (any_angle) return true;
  for (int parts = 24; parts >= 2; --parts) {
    RigidTransform turn = turn_about(centre, axis, 2 * std::numbers::pi / parts);
    if (!self.accept(turn)) continue;
    RigidTransform power = turn;
    for (int k = 1; k < parts; ++k, power = power * turn) {
      RigidTransform refined = power;
      if (self.accept(refined)) add_if_new(refined, found);
    }
    break;
  }
  return false;
}

/// Axes that a symmetry can have: principal axes; where two moments are equal, all directions in their plane.
std::vector<Eigen::Vector3d> possible_axes(const Eigen::Matrix3d& inertia) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  const Eigen::Vector3d& moments = solver.eigenvalues();
  const Eigen::Matrix3d& axes = solver.eigenvectors();
  std::vector<Eigen::Vector3d> possible = {axes.col(0), axes.col(1), axes.col(2)};
  const auto equal = [&](int a, int b) {
    return std::abs(moments[a] - moments[b]) < kEqualInertia * moments[2];
  };
  if (equal(0, 1) && equal(1, 2)) {
    for (const Eigen::Vector3f& v : view_directions(400)) possible.emplace_back(v.cast<double>());
  } else if (equal(0, 1) || equal(1, 2)) {
    const int first = equal(0, 1) ? 0 : 1;
    for (int degrees = 0; degrees < 180; degrees += 3)
      possible.emplace_back(std::cos(radians(degrees)) * axes.col(first) +
                            std::sin(radians(degrees)) * axes.col(first + 1));
  }
  return possible;
}

}  // namespace

Symmetries find_symmetries(const std::vector<OrientedPoint>& surface, float diameter) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& p : surface) centre += p.position.cast<double>() / static_cast<double>(surface.size());
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const auto& p : surface) {
    const Eigen::Vector3d q = p.position.cast<double>() - centre;
    inertia += q * q.transpose();
  }
  const SelfMatch self(surface, diameter);
  Symmetries symmetries;
  for (const Eigen::Vector3d& axis : possible_axes(inertia))
    if (try_axis(self, centre, axis, symmetries.discrete)) {
      const bool known =
          std::any_of(symmetries.continuous.begin(), symmetries.continuous.end(),
                      [&](const SymmetryAxis& a) { return std::abs(a.direction.dot(axis)) > 0.98; });
      if (!known) symmetries.continuous.push_back({centre, axis});
    }
  if (symmetries.continuous.size() == 1) {
    // Turns about the axis itself are covered by it; what is left turns it over.
    const Eigen::Vector3d axis = symmetries.continuous[0].direction;
    std::erase_if(symmetries.discrete,
                  [&](const RigidTransform& t) { return (t.linear() * axis).dot(axis) > 0.98; });
    if (symmetries.discrete.size() > 1) symmetries.discrete.resize(1);
  }
  return symmetries;
}

void store_symmetries(const Symmetries& found, const Symmetries& declared, ModelParts& parts) {
  const Symmetries& chosen = declared.empty() ? found : declared;
  for (const RigidTransform& t : chosen.discrete)
    for (int i = 0; i < 16; ++i) parts.discrete.push_back(t.matrix()(i / 4, i % 4));
  for (const SymmetryAxis& axis : chosen.continuous)
    for (const Eigen::Vector3d& v : {axis.point, axis.direction})
      for (int i = 0; i < 3; ++i) parts.continuous.push_back(v[i]);
}

}  // namespace edgepose
