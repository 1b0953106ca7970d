#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace edgepose {

/// What random numbers are drawn for. Each purpose has its own series of a seed, so that the draws of one do
/// not depend on what else was drawn.
enum class DrawPurpose : uint64_t {
  kStart = 1,
  kIntrinsics,
  kHandEye,
  kTool,
  kDrift,
  kSensor,
  kPose,
  kLandmarks,
  kTouch
};

/// Random numbers, the same on every machine for the same seed and purpose (SplitMix64: Steele, Lea, Flood
/// 2014).
class RandomDraws {
 public:
  RandomDraws(uint64_t seed, DrawPurpose purpose)
      : state_(mixed(mixed(seed) + static_cast<uint64_t>(purpose) * kGolden)) {}

  uint64_t bits() { return mixed(state_ += kGolden); }
  /// In (0, 1): never exactly 0 or 1.
  double uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }
  /// Mean 0, standard deviation 1 (Box and Muller).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  /// Each component of this standard deviation.
  Eigen::Vector3d gauss(double sigma) {
    const double x = normal(), y = normal(), z = normal();
    return sigma * Eigen::Vector3d(x, y, z);
  }
  /// Any direction, any length up to `most`, each length as likely.
  Eigen::Vector3d within(double most) {
    const Eigen::Vector3d direction = gauss(1).normalized();
    return direction * (most * uniform());
  }

 private:
  static constexpr uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  static constexpr uint64_t mixed(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  }

  uint64_t state_;
};

}  // namespace edgepose
