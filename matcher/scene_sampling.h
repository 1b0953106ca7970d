#pragma once
#include <cstdint>
#include <vector>

#include "matcher/scene_data.h"

namespace edgepose {

/// A point of the down-sampled scene.
struct SampledPoint {
  OrientedPoint surface;
  float area = 0;     ///< [m^2] of the surface that it stands for
  bool edge = false;  ///< on an edge of any kind
};

/// The multi-resolution, normal-clustered, edge-preserving down-sampling of the paper's Fig. 4.
struct SamplingOptions {
  float step =
      0.01f;  ///< [m] grid of edge points; twice as wide where the surface is even, half in the first pass
  float fine_theta_deg = 40;    ///< [degrees] normals closer than this merge in the finest grid ...
  float theta_factor = 0.6f;    ///< ... and the threshold shrinks by this factor from level to level
  size_t enough_points = 3000;  ///< a scene with no more points than this at `step` is not thinned further
  float max_pixel_size =
      0.005f;  ///< [m] what is so far away that a pixel spans more is left out: too coarse to match
  float max_noise = 0.003f;  ///< [m] what is measured worse than this is left out too
  bool keep_edges =
      true;         ///< false: every point goes through the same levels up to `step` (no edge emphasis)
  int threads = 0;  ///< 0 = all cores; the result does not depend on it
};

std::vector<SampledPoint> sample_scene(const Scene::Data& scene, const SamplingOptions& options);

/// Drops the points of planes that are larger than any plane of an object of this diameter [m] can be: the
/// table, the wall. What is left is where the object can be.
std::vector<SampledPoint> drop_large_planes(const std::vector<SampledPoint>& points, float diameter,
                                            const NoiseCurve& noise, int threads);

}  // namespace edgepose
