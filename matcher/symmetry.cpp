#include "matcher/symmetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "matcher/symmetry_axis.h"
#include "matcher/symmetry_group.h"

namespace edgepose {
namespace {

constexpr double kSameAxis = 0.998;  // 4 degrees

/// What holds for a surface of revolution besides its axis: it may be a sphere, or may be turned over.
Symmetries about_round_axis(const SelfMatch& self, const SymmetryAxis& axis) {
  SymmetryAxis across = {axis.point, axis.direction.unitOrthogonal()};
  const std::optional<SymmetryAxis> second = find_axis(self, across.direction, std::numbers::pi);
  if (!second || std::abs(second->direction.dot(axis.direction)) > 0.1) return {{}, {axis}};
  // Exactly across, and through the point of the axis that the half turn leaves in place.
  const double along = (second->point - axis.point).dot(axis.direction);
  across.point = axis.point + along * axis.direction;
  across.direction =
      (second->direction - second->direction.dot(axis.direction) * axis.direction).normalized();
  const SymmetryAxis centred = {across.point, axis.direction};
  if (fold_about(self, across).round)
    return {{}, {centred, across, {across.point, axis.direction.cross(across.direction)}}};
  const RigidTransform turned_over = turn_about(across, std::numbers::pi);
  if (!self.distance(turned_over).is_match()) return {{}, {axis}};
  return {{turned_over}, {centred}};
}

}  // namespace

Symmetries find_symmetries(const std::vector<OrientedPoint>& samples, const std::vector<OrientedPoint>& crowd,
                           float diameter) {
  const SelfMatch self(samples, crowd, diameter);
  SymmetryGroup group(self);
  std::vector<Eigen::Vector3d> done;
  const auto is_done = [&](const Eigen::Vector3d& direction) {
    for (const Eigen::Vector3d& d : done)
      if (std::abs(d.dot(direction)) > kSameAxis) return true;
    return false;
  };
  for (const AxisGuess& guess : guess_axes(self.inertia()))
    for (double angle : guess.angles) {
      if (group.is_largest() || is_done(guess.direction) || group.turns_about(guess.direction)) break;
      std::optional<SymmetryAxis> axis = find_axis(self, guess.direction, angle);
      if (!axis || is_done(axis->direction)) continue;
      refit_axis(self, fold_about(self, *axis), *axis);
      const Fold fold = fold_about(self, *axis);
      done.push_back(axis->direction);
      // No finite group goes with a round axis, and no other round one, unless it is a sphere.
      if (fold.round) return about_round_axis(self, *axis);
      if (fold.parts > 1) group.extend(turn_about(*axis, 2 * std::numbers::pi / fold.parts));
    }
  group.make_exact();
  return {group.motions(), {}};
}

bool Symmetries::is_sphere() const {
  return std::any_of(continuous.begin(), continuous.end(), [&](const SymmetryAxis& axis) {
    return std::abs(axis.direction.dot(continuous.front().direction)) < kSameAxis;
  });
}

void store_symmetries(const Symmetries& symmetries, ModelParts& parts) {
  for (const RigidTransform& t : symmetries.discrete)
    for (int i = 0; i < 16; ++i) parts.discrete.push_back(t.matrix()(i / 4, i % 4));
  for (const SymmetryAxis& axis : symmetries.continuous)
    for (const Eigen::Vector3d& v : {axis.point, axis.direction})
      for (int i = 0; i < 3; ++i) parts.continuous.push_back(v[i]);
}

}  // namespace edgepose
