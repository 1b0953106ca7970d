#pragma once
#include <random>

#include "arm/arm_geometry.h"
#include "arm/motion_limiter.h"

namespace edgepose {

/// Draws for tests; the same for the same seed.
struct ArmDraws {
  std::mt19937_64 random;
  explicit ArmDraws(uint64_t seed) : random(seed) {}

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  }
  JointVector joints(const JointVector& low, const JointVector& high) {
    JointVector values;
    for (int i = 0; i < kJoints; ++i) values[i] = between(low[i], high[i]);
    return values;
  }
  Eigen::Vector3d vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
};

/// The tip of a drill of some 20 cm, flange frame.
inline Eigen::Vector3d drill_tip() { return {0.02, -0.01, 0.21}; }

/// A position far from limits and singularities: elbow and wrist bent.
inline JointVector bent() { return (JointVector() << 0.3, -0.4, 1.4, 0.2, 1.5, 0.1).finished(); }

}  // namespace edgepose
