#include "matcher/track.h"

#include <algorithm>
#include <stdexcept>

#include "matcher/detection.h"
#include "matcher/parallel.h"
#include "matcher/stopwatch.h"

namespace edgepose {

MatchResult track(const Scene& scene_handle, const Model& model, const std::vector<TrackStart>& starts,
                  const MatchOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw std::invalid_argument(fault);
  MatchResult result;
  Stopwatch watch;
  const std::vector<OrientedPoint> no_points;
  const CandidateSearch search(scene_handle.data(), model, no_points, options);
  std::vector<Candidate> candidates(starts.size());
  parallel_for(starts.size(), options.threads, [&](size_t i) {
    candidates[i] = search.finish({starts[i].camera_T_model.linear().cast<float>(),
                                   starts[i].camera_T_model.translation().cast<float>()},
                                  0, starts[i].sightings);
  });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  result.candidates = candidates.size();
  result.times.refinement = watch.lap();

  MatchOptions reported = options;
  reported.max_instances = std::max(1, static_cast<int>(std::min<size_t>(starts.size(), 100)));
  Report report = report_detections(scene_handle.data(), model, candidates, search, reported);
  result.detections = std::move(report.detections);
  result.reason = std::move(report.reason);
  result.times.verification = watch.lap();
  return result;
}

}  // namespace edgepose
