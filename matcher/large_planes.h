#pragma once
#include <vector>

#include "matcher/sampled_point.h"
#include "matcher/scene_data.h"

namespace edgepose {

/// Drops the points of planes that are larger than any plane of an object of this diameter [m] can be: the
/// table, the wall. What is left is where the object can be.
std::vector<SampledPoint> drop_large_planes(const std::vector<SampledPoint>& points, float diameter,
                                            const NoiseCurve& noise, int threads);

}  // namespace edgepose
