#include "matcher/bucket_visits.h"

#include "matcher/lanes.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

struct PairFeatures {
  const float *squared, *distance, *first, *second, *normals;
};

struct Spread {
  int32_t *base, *distance, *first, *second, *normals;
};

/// The table's shape and the rule as plain numbers.
struct Limits {
  float squared_reach, border;
  int32_t distance_bins, angle_bins, normal_first, normal_last;
};

/// Sets `own` to the bins of eight values and `step` to the neighbours that are also visited, or 0. A macro,
/// as a function would have to be given lanes. Comparisons of lanes are -1 where they hold.
#define EDGEPOSE_BINS_OF(name, column, bins)                                                \
  const Lanes name##_value = EDGEPOSE_LANES_AT(column, i);                                  \
  const LaneInts name##_whole = __builtin_convertvector(name##_value, LaneInts);            \
  const LaneInts name##_own = name##_whole < (bins) ? name##_whole : zero + (bins)-1;       \
  const Lanes name##_rest = name##_value - __builtin_convertvector(name##_own, Lanes);      \
  const LaneInts name##_down = (name##_rest < limits.border) & (name##_own > 0);            \
  const LaneInts name##_up = (name##_rest > 1 - limits.border) & (name##_own + 1 < (bins)); \
  const LaneInts name##_step = name##_down | (name##_up & ~name##_down & 1)

/// For whole lanes; what lies behind the last pair is computed along.
EDGEPOSE_WIDE_SIMD void spread_features(PairFeatures in, size_t count, Limits limits, Spread out) {
  const int32_t a = limits.angle_bins;
  const LaneInts zero = {};
  for (size_t i = 0; i < count; i += kLanes) {
    EDGEPOSE_BINS_OF(distance, in.distance, limits.distance_bins);
    EDGEPOSE_BINS_OF(normals, in.normals, a);
    EDGEPOSE_BINS_OF(first, in.first, a);
    EDGEPOSE_BINS_OF(second, in.second, a);
    const LaneInts beside = normals_own + normals_step;
    const LaneInts own_held = (normals_own >= limits.normal_first) & (normals_own <= limits.normal_last);
    const LaneInts beside_held =
        (normals_step != 0) & (beside >= limits.normal_first) & (beside <= limits.normal_last);
    const Lanes squared = EDGEPOSE_LANES_AT(in.squared, i);
    const LaneInts counts = (own_held | beside_held) & (squared <= limits.squared_reach) &
                            (squared > 0.f);  // zero: the reference itself
    const LaneInts normal_bin = own_held ? normals_own : beside;
    const LaneInts base = ((distance_own * a + normal_bin) * a + first_own) * a + second_own;
    *reinterpret_cast<LaneInts*>(out.base + i) = base | ~counts;
    *reinterpret_cast<LaneInts*>(out.distance + i) = distance_step * (a * a * a);
    *reinterpret_cast<LaneInts*>(out.normals + i) = (normals_step * (a * a)) & own_held & beside_held;
    *reinterpret_cast<LaneInts*>(out.first + i) = first_step * a;
    *reinterpret_cast<LaneInts*>(out.second + i) = second_step;
  }
}

using LaneAlphas = uint16_t __attribute__((vector_size(32), aligned(2), may_alias));

/// Writes 16 visits for each pair, of which those count that its neighbours make; the rest is written over.
EDGEPOSE_WIDE_SIMD size_t list_buckets(Spread spread, const int32_t* pair_alpha, size_t pairs,
                                       uint32_t* bucket, uint16_t* alpha) {
  constexpr LaneInts kFirst = {0, -1, 0, -1, 0, -1, 0, -1}, kSecond = {0, 0, -1, -1, 0, 0, -1, -1},
                     kThird = {0, 0, 0, 0, -1, -1, -1, -1};
  size_t count = 0;
  for (size_t i = 0; i < pairs; ++i) {
    int32_t steps[4] = {0, 0, 0, 0};  // those that are not 0 first
    size_t neighbours = 0;
    for (const int32_t step : {spread.normals[i], spread.distance[i], spread.first[i], spread.second[i]}) {
      steps[neighbours & 3] = step;
      neighbours += step != 0;
    }
    const LaneInts low = spread.base[i] + (kFirst & steps[0]) + (kSecond & steps[1]) + (kThird & steps[2]);
    *reinterpret_cast<LaneInts*>(bucket + count) = low;
    *reinterpret_cast<LaneInts*>(bucket + count + kLanes) = low + steps[3];
    *reinterpret_cast<LaneAlphas*>(alpha + count) = LaneAlphas{} + static_cast<uint16_t>(pair_alpha[i]);
    count += static_cast<size_t>(spread.base[i] >= 0) << neighbours;
  }
  return count;
}

}  // namespace

void BucketVisits::list(const FeatureBatch& batch, size_t pairs, const FeatureQuantiser& quantiser,
                        const VisitRule& rule) {
  if (base_.size() < pairs) {
    const size_t room = whole_lanes(pairs);
    for (auto* column : {&base_, &distance_, &normals_, &first_, &second_}) column->resize(room);
    bucket_.resize(kMost * room);
    alpha_.resize(kMost * room);
  }
  const Spread spread = {base_.data(), distance_.data(), first_.data(), second_.data(), normals_.data()};
  spread_features({batch.squared_distance.data(), batch.distance.data(), batch.angle_reference.data(),
                   batch.angle_second.data(), batch.angle_normals.data()},
                  pairs,
                  {rule.reach * rule.reach, rule.border, static_cast<int32_t>(quantiser.distance_bins),
                   static_cast<int32_t>(quantiser.angle_bins), static_cast<int32_t>(rule.normal_bin_first),
                   static_cast<int32_t>(rule.normal_bin_last)},
                  spread);
  count_ = list_buckets(spread, batch.alpha.data(), pairs, bucket_.data(), alpha_.data());
}

}  // namespace edgepose
