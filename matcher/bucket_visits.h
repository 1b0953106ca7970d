#pragma once
#include <cstdint>
#include <vector>

#include "matcher/feature_batch.h"

namespace edgepose {

/// Which features vote, and how far their votes spread.
struct VisitRule {
  float reach;                                 ///< [m] pairs farther apart do not vote
  float border;                                ///< [bins] features this close to a border also visit the
                                               ///< next bucket, below 0.5
  uint32_t normal_bin_first, normal_bin_last;  ///< buckets that hold pairs at all
};

/// The buckets that a batch's features fall into, or nearly: up to 16 for each pair, as each of the four
/// dimensions may have a neighbour (Hinterstoisser et al. 2016). Without branches, which nobody could
/// predict.
class BucketVisits {
 public:
  /// Lists the visits of the batch's first `pairs`, in their order.
  void list(const FeatureBatch& batch, size_t pairs, const FeatureQuantiser& quantiser,
            const VisitRule& rule);

  size_t count() const { return count_; }
  uint32_t bucket(size_t i) const { return bucket_[i]; }
  uint16_t alpha(size_t i) const { return alpha_[i]; }  ///< 1/65536 turns, of the scene's second point

 private:
  static constexpr size_t kMost = 16;

  std::vector<int32_t> base_;                                 // of a pair: its first bucket, -1 for none
  std::vector<int32_t> distance_, normals_, first_, second_;  // from there to the neighbour, 0 for none
  std::vector<uint32_t> bucket_;
  std::vector<uint16_t> alpha_;
  size_t count_ = 0;
};

}  // namespace edgepose
