#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace edgepose {

/// Integer cell of a point, packed into 63 bits (21 each, so |coordinate / cell size| must be below 2^20).
inline uint64_t cell_key(int64_t x, int64_t y, int64_t z) {
  constexpr int64_t kOffset = 1 << 20, kMask = (1 << 21) - 1;
  return static_cast<uint64_t>((x + kOffset) & kMask) << 42 |
         static_cast<uint64_t>((y + kOffset) & kMask) << 21 | static_cast<uint64_t>((z + kOffset) & kMask);
}
inline uint64_t cell_key(const Eigen::Vector3f& p, float inverse_size) {
  return cell_key(static_cast<int64_t>(std::floor(p.x() * inverse_size)),
                  static_cast<int64_t>(std::floor(p.y() * inverse_size)),
                  static_cast<int64_t>(std::floor(p.z() * inverse_size)));
}

/// Points hashed into cubic cells for fixed-radius search with radius <= cell size.
class PointGrid {
 public:
  explicit PointGrid(float cell_size) : inverse_size_(1 / cell_size) {}

  void add(const Eigen::Vector3f& p, uint32_t index) { cells_[cell_key(p, inverse_size_)].push_back(index); }

  /// Calls visit(index) for every point in the 27 cells around `p`, until visit returns false.
  template <typename Visit>
  void visit_near(const Eigen::Vector3f& p, const Visit& visit) const {
    const auto cell = [&](float c) { return static_cast<int64_t>(std::floor(c * inverse_size_)); };
    const int64_t x = cell(p.x()), y = cell(p.y()), z = cell(p.z());
    for (int64_t dx = -1; dx <= 1; ++dx)
      for (int64_t dy = -1; dy <= 1; ++dy)
        for (int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = cells_.find(cell_key(x + dx, y + dy, z + dz));
          if (found == cells_.end()) continue;
          for (uint32_t index : found->second)
            if (!visit(index)) return;
        }
  }

 private:
  float inverse_size_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

}  // namespace edgepose
