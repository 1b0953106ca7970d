#pragma once
#include "matcher/oriented_point.h"

namespace edgepose {

/// A point of the down-sampled scene.
struct SampledPoint {
  OrientedPoint surface;
  float area = 0;     ///< [m^2] of the surface that it stands for
  bool edge = false;  ///< on an edge of any kind
};

/// One that others have been merged into.
struct WeightedPoint {
  SampledPoint point;
  float weight = 0;
};

}  // namespace edgepose
