#pragma once
#include "matcher/model.h"

namespace edgepose {

/// How far an estimate is from the truth, as far as it can be seen.
struct SymmetricError {
  double translation = 0;  ///< [m]
  double rotation = 0;     ///< [rad]
};

/// Poses are camera_T_model. Of the poses that the symmetries make equal the nearest in rotation counts;
/// about a continuous axis only its direction does, and about the axes of a sphere nothing.
SymmetricError symmetric_error(const Symmetries& symmetries, const RigidTransform& truth,
                               const RigidTransform& estimate);

}  // namespace edgepose
