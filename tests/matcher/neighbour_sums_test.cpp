#include "matcher/neighbour_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace edgepose {
namespace {

constexpr size_t kBefore = 5, kAfter = 13;  // pixels that must exist beside the row

/// Rows of inverse depths around a slope, with steps and pixels without measurement among them.
class Rows {
 public:
  Rows(size_t width, uint64_t seed) : width_(width), values_(11 * stride()) {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<float> draw(0, 1);
    for (size_t i = 0; i < values_.size(); ++i) {
      values_[i] = 1 + 0.002f * static_cast<float>(i % stride()) + 0.004f * draw(generator);
      if (draw(generator) < 0.2f) values_[i] += 0.5f;
      if (draw(generator) < 0.1f) values_[i] = kNoInverseDepth;
    }
  }
  /// `dv` from -5 to 5; the pointer is to the first pixel of the image.
  const float* row(int dv) const { return values_.data() + static_cast<size_t>(dv + 5) * stride() + kBefore; }

 private:
  size_t stride() const { return kBefore + width_ + kAfter; }
  size_t width_;
  std::vector<float> values_;
};

TEST(NeighbourSums, AreThoseOfAPlainLoop) {
  constexpr float kSlope = 0.003f;
  size_t neighbours = 0;
  for (const size_t width : {1u, 7u, 8u, 33u, 100u}) {
    const Rows image(width, width);
    std::array<const float*, kNeighbourOffsets.size()> rows;
    for (size_t r = 0; r < rows.size(); ++r) rows[r] = image.row(kNeighbourOffsets[r]);
    NeighbourSums sums(width);
    sum_neighbours(rows, image.row(0), SurfaceReach(kSlope), sums);
    for (size_t at = 0; at < width; ++at) {
      const float here = image.row(0)[at];
      if (here == kNoInverseDepth) continue;  // what it gets is not read
      double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, w = 0, xw = 0, yw = 0, ww = 0;
      for (const int dv : kNeighbourOffsets)
        for (const int du : kNeighbourOffsets) {
          const float d = image.row(dv)[static_cast<int>(at) + du] - here;
          const auto x_off = static_cast<float>(du), y_off = static_cast<float>(dv);
          const float reach = kSlope * (std::sqrt(x_off * x_off + y_off * y_off) + 2.f);
          if (!(std::abs(d) < here * reach)) continue;
          n += 1, x += du, y += dv, xx += du * du, xy += du * dv, yy += dv * dv;
          w += d, xw += x_off * d, yw += y_off * d, ww += d * d;
        }
      neighbours += static_cast<size_t>(n);
      EXPECT_EQ(sums.n[at], n);
      EXPECT_EQ(sums.x[at], x);
      EXPECT_EQ(sums.y[at], y);
      EXPECT_EQ(sums.xx[at], xx);
      EXPECT_EQ(sums.xy[at], xy);
      EXPECT_EQ(sums.yy[at], yy);
      EXPECT_NEAR(sums.w[at], w, 1e-5);
      EXPECT_NEAR(sums.xw[at], xw, 5e-5);
      EXPECT_NEAR(sums.yw[at], yw, 5e-5);
      EXPECT_NEAR(sums.ww[at], ww, 1e-6);
    }
  }
  EXPECT_GT(neighbours, 1000u);
}

}  // namespace
}  // namespace edgepose
