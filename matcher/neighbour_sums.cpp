#include "matcher/neighbour_sums.h"

#include <cmath>
#include <cstdint>

#include "matcher/lanes.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr size_t kSide = kNeighbourOffsets.size();

constexpr size_t distance_index(int offset) {
  return static_cast<size_t>((offset < 0 ? -offset : offset) / 2);
}

/// What a neighbour adds to n, x, xx and to y, yy, xy: small whole numbers, the same in whatever order they
/// are added up, so three share one number. Shifted where they can be negative: by 5 each, and by 25.
constexpr int32_t packed_columns(int du) { return 1 | (du + 5) << 8 | (du * du) << 20; }
constexpr int32_t packed_rows(int du, int dv) { return (dv + 5) | (dv * dv) << 10 | (du * dv + 25) << 20; }

}  // namespace

NeighbourSums::NeighbourSums(size_t width) {
  for (auto* sum : {&n, &x, &y, &xx, &xy, &yy, &w, &xw, &yw, &ww}) sum->resize(whole_lanes(width));
}

SurfaceReach::SurfaceReach(float slope) {
  for (const int dv : kNeighbourOffsets)
    for (const int du : kNeighbourOffsets)
      relative[distance_index(dv)][distance_index(du)] =
          slope * (std::sqrt(static_cast<float>(du * du + dv * dv)) + 2.f);  // two pixels more absorb noise
}

EDGEPOSE_WIDE_SIMD void sum_neighbours(const std::array<const float*, kSide>& rows, const float* centre,
                                       const SurfaceReach& reach, NeighbourSums& sums) {
  const auto store = [](std::vector<float>& to, size_t at, const Lanes& lanes) {
    *reinterpret_cast<Lanes*>(to.data() + at) = lanes;
  };
  const size_t count = sums.n.size();
  for (size_t u = 0; u < count; u += kLanes) {
    const Lanes here = EDGEPOSE_LANES_AT(centre, u);
    LaneInts columns = {}, lines = {};
    Lanes w = {}, xw = {}, yw = {}, ww = {};
#pragma GCC unroll 6
    for (size_t r = 0; r < kSide; ++r) {
      const int dv = kNeighbourOffsets[r];
      Lanes rw = {}, rxw = {}, rww = {};
#pragma GCC unroll 6
      for (size_t k = 0; k < kSide; ++k) {
        const int du = kNeighbourOffsets[k];
        const Lanes limit = here * reach.relative[distance_index(dv)][distance_index(du)];
        const Lanes difference = *reinterpret_cast<const Lanes*>(rows[r] + u + du) - here;
        const LaneInts bits = reinterpret_cast<const LaneInts&>(difference);
        const LaneInts size_bits = bits & 0x7fffffff;
        const LaneInts near = reinterpret_cast<const Lanes&>(size_bits) < limit;
        columns += near & packed_columns(du);
        lines += near & packed_rows(du, dv);
        const LaneInts kept = near & bits;
        const Lanes d = reinterpret_cast<const Lanes&>(kept);
        rw += d, rxw += static_cast<float>(du) * d, rww += d * d;
      }
      w += rw, xw += rxw, ww += rww, yw += static_cast<float>(dv) * rw;
    }
    const LaneInts n = columns & 255;
    store(sums.n, u, __builtin_convertvector(n, Lanes));
    store(sums.x, u, __builtin_convertvector((columns >> 8 & 4095) - 5 * n, Lanes));
    store(sums.xx, u, __builtin_convertvector(columns >> 20, Lanes));
    store(sums.y, u, __builtin_convertvector((lines & 1023) - 5 * n, Lanes));
    store(sums.yy, u, __builtin_convertvector(lines >> 10 & 1023, Lanes));
    store(sums.xy, u, __builtin_convertvector((lines >> 20) - 25 * n, Lanes));
    store(sums.w, u, w), store(sums.xw, u, xw), store(sums.yw, u, yw), store(sums.ww, u, ww);
  }
}

}  // namespace edgepose
