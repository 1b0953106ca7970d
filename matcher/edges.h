#pragma once
#include "matcher/scene_data.h"

namespace edgepose {

/// Fills scene.edges from depth and normals: depth jumps (near side only), borders of the measured area, and
/// creases. Needs estimate_normals() first.
void detect_edges(Scene::Data& scene, int threads);

}  // namespace edgepose
