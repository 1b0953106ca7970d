#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

namespace edgepose::internal {

/// Random numbers that depend only on (seed, pixel, stream): no state, so threads cannot change them.
/// The mixing function is SplitMix64's finaliser (Steele, Lea, Flood 2014).
class PixelRandom {
 public:
  PixelRandom(uint64_t seed, int u, int v)
      : key_(mix(mix(seed + kGolden) ^ (static_cast<uint64_t>(static_cast<uint32_t>(u)) << 32 |
                                        static_cast<uint64_t>(static_cast<uint32_t>(v))))) {}

  /// Uniform in (0, 1): never exactly 0 or 1.
  double uniform(uint32_t stream) const {
    return (static_cast<double>(mix(key_ + kGolden * (stream + 1)) >> 12) + 0.5) * 0x1p-52;
  }

  /// Mean 0, standard deviation 1 (Box and Muller). Uses up the streams `stream` and `stream` + 1000.
  double normal(uint32_t stream) const {
    return std::sqrt(-2 * std::log(uniform(stream))) *
           std::cos(2 * std::numbers::pi * uniform(stream + 1000));
  }

 private:
  static constexpr uint64_t kGolden = 0x9e3779b97f4a7c15ULL;

  static constexpr uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  }

  uint64_t key_;
};

}  // namespace edgepose::internal
