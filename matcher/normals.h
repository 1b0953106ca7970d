#pragma once
#include "matcher/scene_data.h"

namespace edgepose {

/// Fills smooth_depth, normals and noise from depth: a plane fitted to each pixel's neighbourhood (11 x 11
/// pixels, every second one) without the neighbours beyond a depth jump.
void estimate_normals(Scene::Data& scene, int threads);

}  // namespace edgepose
