#pragma once
#include <vector>

#include "arm/types.h"

namespace edgepose {

/// How far poses are from their mean, root mean square.
struct PoseSpread {
  double translation = 0;  ///< [m]
  double rotation = 0;     ///< [rad]
};

/// The mean of rotations that minimises the sum of squared chordal distances: the sum of the matrices,
/// projected to the nearest rotation by SVD (Hartley, Trumpf, Dai and Li, Rotation Averaging, IJCV 103, 2013,
/// Sec. 5.3); translations are averaged as vectors. At least one pose, all proper, rotations within a right
/// angle of each other: farther apart the mean of rotations means little.
RigidTransform mean_pose(const std::vector<RigidTransform>& poses);
PoseSpread spread(const std::vector<RigidTransform>& poses, const RigidTransform& mean);

}  // namespace edgepose
