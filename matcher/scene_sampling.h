#pragma once
#include <vector>

#include "matcher/match_options.h"
#include "matcher/sampled_point.h"
#include "matcher/scene_data.h"

namespace edgepose {

/// Down-samples the scene as the paper's Fig. 4 does. `step` [m]: grid of edge points, to within 9 % (see
/// SampleScale); twice as wide where the surface is even. `diameter` [m]: what the options' limits are
/// relative to. The samples stay with the scene. The result depends neither on `threads` nor on what was
/// asked for before.
std::vector<SampledPoint> sample_scene(const Scene::Data& scene, float step, float diameter,
                                       const SamplingOptions& options, int threads);

}  // namespace edgepose
