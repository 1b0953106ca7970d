#pragma once
#include "matcher/candidate_search.h"

namespace edgepose {

/// The cells of the image (6 x 6 pixels) in which the posed model explains what was measured; sorted.
std::vector<uint32_t> explained_cells(const Scene::Data& scene, const Model::View& model,
                                      const PoseF& camera_T_model, const FreeSpaceOptions& options);

/// Share of `cells` that is also in `others`; both sorted.
float overlap(const std::vector<uint32_t>& cells, const std::vector<uint32_t>& others);

/// What is reported of the candidates: the best of each place, with covariance, margin and symmetric poses.
/// At most options.max_instances; only the first may be one that is not accepted.
std::vector<Detection> report_detections(const Scene::Data& scene, const Model& model,
                                         const std::vector<Candidate>& ranked, const CandidateSearch& search,
                                         const MatchOptions& options);

/// Why the best candidate was not accepted, in words.
std::string rejection_reason(const std::vector<Candidate>& ranked, const MatchOptions& options);

}  // namespace edgepose
