#pragma once
#include <cstdint>
#include <vector>

#include "matcher/pair_feature.h"
#include "matcher/partner_search.h"

namespace edgepose {

/// The features of one reference with a run of partners: FeatureQuantiser::feature() and
/// ReferenceFrame::alpha(), for many at once; with room for whole lanes.
struct FeatureBatch {
  std::vector<float> squared_distance;                                        ///< [m^2]
  std::vector<float> distance, angle_reference, angle_second, angle_normals;  ///< in steps, as in PairFeature
  std::vector<int32_t> alpha;  ///< 1/65536 turns; low 16 bits count

  /// Computes what the run [begin, end) of `points` gives with `reference`.
  void compute(const OrientedPoint& reference, const ReferenceFrame& frame, const PointArrays& points,
               PartnerSearch::Run run, const FeatureQuantiser& quantiser);
};

}  // namespace edgepose
