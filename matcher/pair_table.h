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
  uint32_t normal_bin_first, normal_bin_last;    ///< buckets of the angle between the normals that are kept
  std::vector<std::vector<uint64_t>> seen_from;  ///< for each point the set of views; pairs without a common
                                                 ///< view can never be measured together and are left out
};

PairTable build_pair_table(const std::vector<OrientedPoint>& points, const FeatureQuantiser& quantiser,
                           const PairFilter& filter, int threads);

}  // namespace edgepose
