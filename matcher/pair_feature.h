#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "matcher/oriented_point.h"

namespace edgepose {

/// arccos with an error below 7e-5 rad (Abramowitz and Stegun 4.4.45), much faster than the library's.
inline float fast_acos(float x) {
  const float a = std::min(std::abs(x), 1.f);
  const float r = std::sqrt(1 - a) * (1.5707288f + a * (-0.2121144f + a * (0.0742610f - 0.0187293f * a)));
  return x < 0 ? std::numbers::pi_v<float> - r : r;
}

/// atan2 in turns, [-0.5, 0.5], with an error below 1e-5 turns (minimax polynomial of degree 11).
inline float fast_atan2_turns(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float high = std::max(ax, ay), low = std::min(ax, ay);
  const float q = high > 0 ? low / high : 0.f, s = q * q;
  float r =
      q * (0.15915131f +
           s * (-0.05293868f + s * (0.03080340f + s * (-0.01853087f + s * (0.00838004f - s * 0.00186549f)))));
  if (ay > ax) r = 0.25f - r;
  if (x < 0) r = 0.5f - r;
  return y < 0 ? -r : r;
}

/// The point pair feature of the paper's Eq. 1, d = p_r - p_s, in units of the table's steps, unquantised.
struct PairFeature {
  float distance;         ///< |d| in distance steps
  float angle_reference;  ///< angle(n_r, d) in angle steps
  float angle_second;     ///< angle(n_s, d) in angle steps
  float angle_normals;    ///< angle(n_r, n_s) in angle steps
};

/// How features are cut into buckets; model and scene must use the same.
struct FeatureQuantiser {
  float inverse_distance_step;  ///< [1/m]
  float inverse_angle_step;     ///< [1/rad]
  uint32_t distance_bins, angle_bins;

  PairFeature feature(const OrientedPoint& reference, const OrientedPoint& second, float distance) const {
    const Eigen::Vector3f d = (reference.position - second.position) / distance;
    return {distance * inverse_distance_step, fast_acos(reference.normal.dot(d)) * inverse_angle_step,
            fast_acos(second.normal.dot(d)) * inverse_angle_step,
            fast_acos(reference.normal.dot(second.normal)) * inverse_angle_step};
  }
  uint32_t angle_bin(float angle) const { return std::min(static_cast<uint32_t>(angle), angle_bins - 1); }
  uint32_t bucket(uint32_t distance, uint32_t reference, uint32_t second, uint32_t normals) const {
    return ((distance * angle_bins + normals) * angle_bins + reference) * angle_bins + second;
  }
  size_t bucket_count() const { return size_t{distance_bins} * angle_bins * angle_bins * angle_bins; }
};

/// The frame in which alpha is measured: the reference point at the origin, its normal along x.
struct ReferenceFrame {
  Eigen::Matrix3f rotation;  ///< rows: normal, and two directions in the tangent plane
  Eigen::Vector3f origin;

  explicit ReferenceFrame(const OrientedPoint& reference) : origin(reference.position) {
    const Eigen::Vector3f y = reference.normal.unitOrthogonal();
    rotation.row(0) = reference.normal;
    rotation.row(1) = y;
    rotation.row(2) = reference.normal.cross(y);
  }
  /// alpha of a second point: the turn about the normal from the frame's y axis to it, in 1/65536 turns.
  uint16_t alpha(const Eigen::Vector3f& second) const {
    const Eigen::Vector3f d = second - origin;
    const float turns = fast_atan2_turns(rotation.row(2).dot(d), rotation.row(1).dot(d));
    return static_cast<uint16_t>(static_cast<int32_t>(turns * 65536.f));
  }
};

}  // namespace edgepose
