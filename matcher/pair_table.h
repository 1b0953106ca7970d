#pragma once
#include <vector>

#include "matcher/model_block.h"
#include "matcher/pair_feature.h"

namespace edgepose {

/// The model's point pairs in buckets of like features, one flat array (paper Sec. 4.2).
struct PairTable {
  std::vector<uint32_t> offsets;
  std::vector<PairEntry> entries;
};

/// Which pairs are stored.
struct PairFilter {
  float min_normal_angle, max_normal_angle;      ///< [rad] kept angles between the normals, ends included
  std::vector<std::vector<uint64_t>> seen_from;  ///< for each point the set of views; pairs without a common
                                                 ///< view can never be measured together and are left out
};

/// The buckets of the angle between the normals that can hold a kept pair; the scene looks at no others.
std::pair<uint32_t, uint32_t> normal_bins(const PairFilter& filter, const FeatureQuantiser& quantiser);

/// Bytes that the table would take: exact for the buckets; for the pairs to about 5 %, counted at a few
/// hundred of the points.
struct TableSize {
  double bucket_bytes, pair_bytes;
  double total() const { return bucket_bytes + pair_bytes; }
};
TableSize estimate_table(const std::vector<OrientedPoint>& points, const FeatureQuantiser& quantiser,
                         const PairFilter& filter);

PairTable build_pair_table(const std::vector<OrientedPoint>& points, const FeatureQuantiser& quantiser,
                           const PairFilter& filter, int threads);

}  // namespace edgepose
