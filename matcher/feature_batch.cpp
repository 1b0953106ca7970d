#include "matcher/feature_batch.h"

#include "matcher/lanes.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

/// Everything about the reference as plain numbers, so that no Eigen type enters the loop.
struct ReferenceNumbers {
  float x, y, z, nx, ny, nz;     // position [m] and normal
  float ux, uy, uz, vx, vy, vz;  // the frame's axes in the tangent plane
  float inverse_distance_step, inverse_angle_step;
};

struct Partners {
  const float *x, *y, *z, *nx, *ny, *nz;
};

struct FeatureColumns {
  float *squared, *distance, *first, *second, *normals;
  int32_t* alpha;
};

EDGEPOSE_WIDE_SIMD void compute_features(ReferenceNumbers r, Partners p, size_t count, FeatureColumns out) {
  EDGEPOSE_NO_OVERLAP
  for (size_t i = 0; i < count; ++i) {
    const float dx = r.x - p.x[i], dy = r.y - p.y[i], dz = r.z - p.z[i];  // d = p_r - p_s
    const float squared = dx * dx + dy * dy + dz * dz;
    const float distance = std::sqrt(squared);
    const float inverse = 1 / std::max(distance, 1e-12f);
    out.squared[i] = squared;
    out.distance[i] = distance * r.inverse_distance_step;
    const float first = (r.nx * dx + r.ny * dy + r.nz * dz) * inverse;
    const float second = (p.nx[i] * dx + p.ny[i] * dy + p.nz[i] * dz) * inverse;
    const float normals = r.nx * p.nx[i] + r.ny * p.ny[i] + r.nz * p.nz[i];
    out.first[i] = fast_acos(first) * r.inverse_angle_step;
    out.second[i] = fast_acos(second) * r.inverse_angle_step;
    out.normals[i] = fast_acos(normals) * r.inverse_angle_step;
    const float along = -(r.ux * dx + r.uy * dy + r.uz * dz), across = -(r.vx * dx + r.vy * dy + r.vz * dz);
    out.alpha[i] = static_cast<int32_t>(fast_atan2_turns(across, along) * 65536.f);
  }
}

}  // namespace

void FeatureBatch::compute(const OrientedPoint& reference, const ReferenceFrame& frame,
                           const PointArrays& points, PartnerSearch::Run run,
                           const FeatureQuantiser& quantiser) {
  const size_t count = run.second - run.first, at = run.first;
  if (squared_distance.size() < count) {
    for (auto* values : {&squared_distance, &distance, &angle_reference, &angle_second, &angle_normals})
      values->resize(whole_lanes(count));
    alpha.resize(whole_lanes(count));
  }
  const Eigen::Vector3f &o = reference.position, &n = reference.normal;
  const Eigen::Vector3f u = frame.rotation.row(1), v = frame.rotation.row(2);
  compute_features({o.x(), o.y(), o.z(), n.x(), n.y(), n.z(), u.x(), u.y(), u.z(), v.x(), v.y(), v.z(),
                    quantiser.inverse_distance_step, quantiser.inverse_angle_step},
                   {points.x.data() + at, points.y.data() + at, points.z.data() + at, points.nx.data() + at,
                    points.ny.data() + at, points.nz.data() + at},
                   count,
                   {squared_distance.data(), distance.data(), angle_reference.data(), angle_second.data(),
                    angle_normals.data(), alpha.data()});
}

}  // namespace edgepose
