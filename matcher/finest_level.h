#pragma once
#include <vector>

#include "matcher/sampled_point.h"
#include "matcher/scene_data.h"

namespace edgepose {

/// How the finest level is made.
struct Finest {
  int stride;                       ///< pixels
  float cell;                       ///< [m]
  float theta_deg;                  ///< [degrees]
  float max_pixel_size, max_noise;  ///< [m] pixels that are larger, or measured worse, are left out
};
/// The finest level of the whole image. The result does not depend on `threads`.
std::vector<WeightedPoint> finest_level(const Scene::Data& scene, const Finest& how, int threads);

}  // namespace edgepose
