#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace edgepose {

/// Columns and rows of a pixel's neighbours, relative to it.
inline constexpr std::array<int, 6> kNeighbourOffsets = {-5, -3, -1, 1, 3, 5};

/// Inverse depth of a pixel without measurement: so far from any other that it is nobody's neighbour.
inline constexpr float kNoInverseDepth = -1e30f;

/// Sums of the least-squares fit w = a du + b dv + c for each pixel of a row, over the neighbours on the same
/// surface; `w` is the inverse depth relative to the pixel's. Structure of arrays, so that pixels are worked
/// on side by side.
struct NeighbourSums {
  explicit NeighbourSums(size_t width);
  std::vector<float> n, x, y, xx, xy, yy, w, xw, yw, ww;
};

/// The largest change of inverse depth to a neighbour on the same surface, relative to the pixel's own.
class SurfaceReach {
 public:
  /// `slope`: that change for each pixel of distance.
  explicit SurfaceReach(float slope);
  std::array<std::array<float, 3>, 3> relative;  ///< of |dv| and |du| = 1, 3, 5
};

/// Fills `sums` for the pixels of a row. `rows`: inverse depth of the neighbours' rows, of which five pixels
/// before the first and 13 after the last must exist; `centre`: of the row itself.
void sum_neighbours(const std::array<const float*, kNeighbourOffsets.size()>& rows, const float* centre,
                    const SurfaceReach& reach, NeighbourSums& sums);

}  // namespace edgepose
