#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgepose {

/// Gives each distinct place one index: vertices are equal if their coordinates are (0 equals -0; NaN with
/// the same bits equals itself). A hash table, so that a million corners take some 50 ms.
class VertexWeld {
 public:
  /// Index of `vertex` among the distinct ones, in the order of their first appearance.
  uint32_t add(const Eigen::Vector3f& vertex);

  const std::vector<Eigen::Vector3f>& vertices() const { return vertices_; }
  std::vector<Eigen::Vector3f> take() { return std::move(vertices_); }

 private:
  void grow();
  size_t slot_of(const Eigen::Vector3f& vertex) const;

  std::vector<Eigen::Vector3f> vertices_;
  std::vector<uint32_t> slots_;  ///< 1 + index, 0 = free; a power of two, at most half full
};

}  // namespace edgepose
