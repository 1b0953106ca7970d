#pragma once
#include "matcher/candidate_search.h"

namespace edgepose {

/// The cells of the image (6 x 6 pixels) in which the posed model explains what was measured; sorted.
std::vector<uint32_t> explained_cells(const Scene::Data& scene, const Model::View& model,
                                      const PoseF& camera_T_model, const FreeSpaceOptions& options);

/// Share of `cells` that is also in `others`; both sorted.
float overlap(const std::vector<uint32_t>& cells, const std::vector<uint32_t>& others);

/// What is reported of the candidates.
struct Report {
  std::vector<Detection> detections;  ///< accepted ones first; at most one that is not, the best guess
  std::string reason;                 ///< why none is accepted, in words; empty if one is
};

/// Refines the best candidate of each place once more, and adds covariance, margin and symmetric poses. At
/// most options.max_instances.
Report report_detections(const Scene::Data& scene, const Model& model, const std::vector<Candidate>& ranked,
                         const CandidateSearch& search, const MatchOptions& options);

}  // namespace edgepose
