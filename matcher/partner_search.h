#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "matcher/oriented_point.h"

namespace edgepose {

/// Oriented points as structure of arrays.
struct PointArrays {
  std::vector<float> x, y, z;     ///< [m]
  std::vector<float> nx, ny, nz;  ///< unit normals
};

/// The scene's points sorted into rows of cells, so that the partners of a reference lie in a few long runs.
class PartnerSearch {
 public:
  using Run = std::pair<uint32_t, uint32_t>;  ///< [begin, end) in the sorted order

  /// `reach` [m]: how far from a reference its partners can be.
  PartnerSearch(const std::vector<OrientedPoint>& points, float reach);

  /// The runs that hold every point within reach of `centre`, and others; sorted, without empty ones.
  void runs_near(const Eigen::Vector3f& centre, std::vector<Run>& runs) const;

  const PointArrays& points() const { return sorted_; }

 private:
  std::array<int64_t, 3> cell(const Eigen::Vector3f& p) const;

  float inverse_cell_;
  std::vector<uint64_t> keys_;  // of the cells, ascending: z, y, x
  PointArrays sorted_;
};

}  // namespace edgepose
