#pragma once
#include <cstdint>
#include <vector>

#include "matcher/oriented_point.h"
#include "matcher/types.h"

namespace edgepose {

/// `count` points spread over the mesh in proportion to area, each with its triangle's normal (blended from
/// the vertices' normals where the mesh has them); a cloud's own points, thinned to `count`.
/// In random order, the same for the same seed.
/// Throws std::invalid_argument if the mesh has no area, or if a cloud has fewer than 100 points or no
/// normals.
std::vector<OrientedPoint> sample_surface(const Mesh& mesh, size_t count, uint64_t seed);

/// Indices of points that keep `step` [m] apart, chosen greedily in order. With several decreasing `steps`
/// the result is progressive: each prefix covers the surface evenly.
std::vector<uint32_t> thin_out(const std::vector<OrientedPoint>& points, const std::vector<float>& steps);

/// The mean normal of `points` within `radius` [m] of points[of[i]] that face the same way (positive dot
/// product, so the two sides of a thin wall stay apart).
std::vector<OrientedPoint> smooth_normals(const std::vector<OrientedPoint>& points,
                                          const std::vector<uint32_t>& of, float radius, int threads);

/// The largest distance between two points [m], to within 0.1 %.
float largest_distance(const std::vector<OrientedPoint>& points);

}  // namespace edgepose
