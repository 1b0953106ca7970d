#pragma once
#include <vector>

#include "matcher/model_block.h"
#include "matcher/pose_projection.h"

namespace edgepose {

/// Tells whether two poses of a model are nearly the same, its symmetries used up.
class PoseComparison {
 public:
  explicit PoseComparison(const Model& model);

  /// True if the model's centre is less than `distance` [d] apart and the rest of the turn less than `angle`
  /// [rad].
  bool alike(const PoseF& a, const PoseF& b, float distance, float angle) const;
  /// Whether they are no farther apart than 0.1 diameters and 15 degrees: what differs more is another
  /// answer.
  bool same_answer(const PoseF& a, const PoseF& b) const { return alike(a, b, 0.1f, 0.26f); }

 private:
  float diameter_;
  Eigen::Vector3f centre_;              // a point that no symmetry moves
  std::vector<Eigen::Matrix3f> turns_;  // of the discrete symmetries, the identity first
  std::vector<Eigen::Vector3f> axes_;   // of the continuous ones
  bool any_turn_;                       // a sphere
};

}  // namespace edgepose
