#pragma once
#include <vector>

#include "matcher/self_match.h"

namespace edgepose {

/// A finite group of rotations that map a surface onto itself: with two motions also their products.
class SymmetryGroup {
 public:
  explicit SymmetryGroup(const SelfMatch& self);

  /// Adds a motion and all that follows from it. Nothing is changed if a product is no symmetry of the
  /// surface, which happens where the motion was only almost one.
  bool extend(const RigidTransform& motion);

  bool contains(const RigidTransform& motion) const;
  /// True if some motion of the group turns about a direction within a few degrees of this one.
  bool turns_about(const Eigen::Vector3d& direction) const;

  /// True for the icosahedron's: nothing can be added.
  bool is_largest() const { return motions_.size() >= 60; }

  /// Makes the fitted motions an exact group: products of members are members to the last digits, angles are
  /// exact parts of a turn, and one point stays in place.
  void make_exact();

  /// All but the identity.
  std::vector<RigidTransform> motions() const { return {motions_.begin() + 1, motions_.end()}; }

 private:
  const SelfMatch& self_;
  std::vector<RigidTransform> motions_;  // the identity first
};

}  // namespace edgepose
