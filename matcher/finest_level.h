#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "matcher/sampled_point.h"
#include "matcher/scene_data.h"

namespace edgepose {

/// How the finest level is made, and what the next one will be.
struct Finest {
  int stride;                       ///< pixels
  float cell, next_cell;            ///< [m]
  float theta_deg;                  ///< [degrees]
  float max_pixel_size, max_noise;  ///< [m]
};

/// A point of the finest level, and its cell of the next.
struct FinePoint {
  uint64_t next_key;
  uint32_t number;  ///< in its strip
  WeightedPoint mean;
};

/// The next level's cells in groups that threads can merge at the same time.
inline constexpr size_t kCellGroups = 8;
inline size_t cell_group(uint64_t key) {
  return key * 0x9e3779b97f4a7c15ull >> 24 & (kCellGroups - 1);  // bits that choose no slot of a hash table
}

/// The finest level of one strip of the image.
struct FineStrip {
  std::array<std::vector<FinePoint>, kCellGroups> groups;  ///< each by rising number
  uint32_t count = 0;                                      ///< points in all of them
};

/// The finest level of the whole image, in strips that threads share; what strips have in common merges in
/// the next level. The result does not depend on `threads`.
std::vector<FineStrip> finest_level(const Scene::Data& scene, const Finest& how, int threads);

}  // namespace edgepose
