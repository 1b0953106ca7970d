#pragma once
#include <random>

#include "arm/rigid_motion.h"
#include "servoing/chain.h"

namespace edgepose {

/// Draws for tests; the same for the same seed.
struct Draws {
  std::mt19937_64 random;
  std::normal_distribution<double> normal;
  explicit Draws(uint64_t seed) : random(seed) {}

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  }
  Eigen::Vector3d vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
  Eigen::Vector3d gauss(double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return sigma * Eigen::Vector3d(x, y, z);
  }
  /// Any direction, any length up to `size`.
  Eigen::Vector3d within(double size) { return gauss(1).normalized() * between(0, size); }
  RigidTransform pose(double angle, double distance) {
    const Eigen::Vector3d turn = within(angle);
    return rigid_transform(rotation_matrix(turn), within(distance));
  }
};

/// A drill of 20 cm on the flange, and a camera beside it that looks at the tip from `distance` [m].
inline ToldCalibration true_rig(double distance = 0.35) {
  constexpr double kAside = 0.1, kLength = 0.2;
  ToldCalibration rig;
  rig.flange_T_tool.translation() << 0, 0, kLength;
  const double tilt = std::asin(kAside / distance);
  rig.flange_T_camera = rigid_transform(rotation_matrix(Eigen::Vector3d(0, -tilt, 0)),
                                        {kAside, 0, kLength - distance * std::cos(tilt)});
  return rig;
}

inline double difference(const RigidTransform& a, const RigidTransform& b) {
  return (a.matrix() - b.matrix()).norm();
}

}  // namespace edgepose
