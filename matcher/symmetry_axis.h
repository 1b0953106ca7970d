#pragma once
#include <optional>
#include <vector>

#include "matcher/model.h"
#include "matcher/self_match.h"

namespace edgepose {

RigidTransform turn_about(const SymmetryAxis& axis, double angle);

/// A direction that may be an axis, and the angles [rad] to try about it. A try finds any symmetry whose
/// axis is a few degrees and whose angle is less than half a tooth away.
struct AxisGuess {
  Eigen::Vector3d direction;
  std::vector<double> angles;
};
/// All that the second moments leave open: a turn by less than half round needs two equal moments.
std::vector<AxisGuess> guess_axes(const Eigen::Matrix3d& inertia);

/// The exact axis of the symmetry near a turn by `angle` about a guessed axis through the centroid; none if
/// the surface does not match itself there.
std::optional<SymmetryAxis> find_axis(const SelfMatch& self, const Eigen::Vector3d& direction, double angle);

/// How a surface repeats about an axis.
struct Fold {
  bool round = false;  ///< any turn will do
  int parts = 1;       ///< else the turns by 1 / parts of a full turn and their multiples
};
Fold fold_about(const SelfMatch& self, const SymmetryAxis& axis);

/// Fits the axis to several of its turns.
void refit_axis(const SelfMatch& self, const Fold& fold, SymmetryAxis& axis);

}  // namespace edgepose
