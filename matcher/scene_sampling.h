#pragma once
#include <cstdint>
#include <vector>

#include "matcher/match_options.h"
#include "matcher/scene_data.h"

namespace edgepose {

/// A point of the down-sampled scene.
struct SampledPoint {
  OrientedPoint surface;
  float area = 0;     ///< [m^2] of the surface that it stands for
  bool edge = false;  ///< on an edge of any kind
};

/// Down-samples the scene as the paper's Fig. 4 does. `step` [m]: grid of edge points; twice as wide where
/// the surface is even, half in the first pass. `diameter` [m]: what the options' limits are relative to. The
/// result does not depend on `threads`.
std::vector<SampledPoint> sample_scene(const Scene::Data& scene, float step, float diameter,
                                       const SamplingOptions& options, int threads);

/// Drops the points of planes that are larger than any plane of an object of this diameter [m] can be: the
/// table, the wall. What is left is where the object can be.
std::vector<SampledPoint> drop_large_planes(const std::vector<SampledPoint>& points, float diameter,
                                            const NoiseCurve& noise, int threads);

}  // namespace edgepose
