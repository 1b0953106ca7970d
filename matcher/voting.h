#pragma once
#include <vector>

#include "matcher/match_options.h"
#include "matcher/model_block.h"
#include "matcher/partner_search.h"
#include "matcher/types.h"

namespace edgepose {

/// A pose with the votes behind it.
struct PoseHypothesis {
  Eigen::Matrix3f rotation;     ///< of camera_T_model
  Eigen::Vector3f translation;  ///< [m] of camera_T_model
  float votes;
};

/// Votes in (model point, alpha) for each reference (paper Sec. 3.2; duplicate flags of Hinterstoisser et al.
/// 2016) and returns the peaks, `peaks_per_reference` for each reference in order.
/// `points`: all scene points, camera frame; `partners`: the same, prepared for a reach of the model's
/// diameter; `references`: indices into the points.
std::vector<PoseHypothesis> vote(const Model& model, const std::vector<OrientedPoint>& points,
                                 const PartnerSearch& partners, const std::vector<uint32_t>& references,
                                 const VotingOptions& options, int threads);

}  // namespace edgepose
