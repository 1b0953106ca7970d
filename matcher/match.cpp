#include "matcher/match.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

#include "matcher/clustering.h"
#include "matcher/detection.h"
#include "matcher/large_planes.h"
#include "matcher/paper_verification.h"
#include "matcher/parallel.h"
#include "matcher/scene_sampling.h"
#include "matcher/stopwatch.h"

namespace edgepose {
namespace {

/// A seeded random subset, so that every prefix is spread over the scene.
std::vector<uint32_t> pick_references(size_t points, size_t wanted, uint64_t seed) {
  std::vector<uint32_t> order(points);
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937_64 generator(seed);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[generator() % i]);
  order.resize(std::min(order.size(), wanted));
  return order;
}

/// The paper takes its share, whatever the scene's size.
size_t wanted_references(size_t points, const MatchOptions& options) {
  const auto share =
      static_cast<size_t>(std::ceil(options.voting.reference_share * static_cast<float>(points)));
  if (options.verification != Verification::kFreeSpace) return std::max<size_t>(share, 1);
  const auto fewest =
                 static_cast<size_t>(options.voting.min_references) * (options.max_instances > 1 ? 2 : 1),
             most = static_cast<size_t>(options.voting.max_references);
  return std::clamp(share, std::min(fewest, most), most);
}

/// The scene's points for this model (paper Fig. 4), without the planes that are too large to be on it.
/// What is measured too coarsely or too badly to be matched well is left out, unless there is nothing else.
std::vector<OrientedPoint> scene_points(const Scene::Data& scene, const Model& model,
                                        const MatchOptions& options) {
  constexpr size_t kEnough = 200;
  const float d = static_cast<float>(model.diameter());
  const float step = static_cast<float>(model.view().header->sampling_step);
  SamplingOptions sampling = options.sampling;
  const auto take = [&] {
    return drop_large_planes(sample_scene(scene, step, d, sampling, options.threads), d, scene.noise,
                             options.threads);
  };
  std::vector<SampledPoint> samples = take();
  if (samples.size() < kEnough) {
    sampling.max_pixel_size = std::max(sampling.max_pixel_size, 1 / 12.f);
    sampling.max_noise = std::max(sampling.max_noise, 0.1f);
    samples = take();
  }
  std::vector<OrientedPoint> points;
  points.reserve(samples.size());
  for (const SampledPoint& p : samples) points.push_back(p.surface);
  return points;
}

/// The paper's way: all references vote at once, one pose is chosen by edges (or by surface overlap) and
/// refined.
std::vector<Candidate> choose_like_the_paper(const Scene::Data& scene, const Model& model,
                                             const std::vector<OrientedPoint>& points,
                                             const std::vector<uint32_t>& references,
                                             const CandidateSearch& search, const MatchOptions& options,
                                             MatchResult& result) {
  Stopwatch watch;
  const PartnerSearch partners(points, static_cast<float>(model.diameter()));
  auto hypotheses = vote(model, points, partners, references, options.voting, options.threads);
  result.times.voting = watch.lap();
  const auto clusters = cluster_poses(std::move(hypotheses), model, options.clustering);
  result.candidates = clusters.size();
  result.times.clustering = watch.lap();
  if (clusters.empty()) return {};

  std::vector<PoseF> poses;
  std::vector<float> votes;
  for (const PoseHypothesis& c : clusters)
    poses.push_back({c.rotation, c.translation}), votes.push_back(c.votes);
  const float d = static_cast<float>(model.diameter());
  size_t chosen = 0;
  if (options.verification == Verification::kPaper) {
    const SceneEdges edges(scene, 0.01f * d, d / 32);
    chosen = verify_like_the_paper(edges, model.view(), poses, votes, options.paper, options.threads);
  } else {
    const size_t looked_at =
        std::min<size_t>(poses.size(), 2 * static_cast<size_t>(options.paper.candidates));
    std::vector<float> overlaps;
    for (size_t i = 0; i < looked_at; ++i)
      overlaps.push_back(surface_overlap(scene, model.view(), poses[i], options.paper.edge_distance * d));
    chosen = static_cast<size_t>(std::max_element(overlaps.begin(), overlaps.end()) - overlaps.begin());
  }
  result.times.verification = watch.lap();
  std::vector<Candidate> candidates = {search.finish(poses[chosen], votes[chosen])};
  result.times.refinement = watch.lap();
  return candidates;
}

}  // namespace

MatchResult match(const Scene& scene_handle, const Model& model, const MatchOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw std::invalid_argument(fault);
  const Scene::Data& scene = scene_handle.data();
  MatchResult result;
  Stopwatch watch;
  const auto points = scene_points(scene, model, options);
  const auto references =
      pick_references(points.size(), wanted_references(points.size(), options), options.seed);
  result.scene_points = points.size();
  result.reference_points = references.size();
  result.times.sampling = watch.lap();

  const CandidateSearch search(scene, model, points, options);
  const auto candidates =
      options.verification == Verification::kFreeSpace
          ? search.run(references, result)
          : choose_like_the_paper(scene, model, points, references, search, options, result);
  watch.lap();
  Report report = report_detections(scene, model, candidates, search, options);
  result.detections = std::move(report.detections);
  result.reason = std::move(report.reason);
  result.times.verification += watch.lap();
  return result;
}

void resolve_conflicts(const Scene& scene_handle, const std::vector<const Model*>& models,
                       const MatchOptions& options, std::vector<MatchResult>& results) {
  if (options.verification != Verification::kFreeSpace || models.size() < 2) return;
  struct Claim {
    size_t model, detection;
    std::vector<uint32_t> cells;
  };
  const Scene::Data& scene = scene_handle.data();
  std::vector<Claim> claims;
  for (size_t m = 0; m < results.size(); ++m) {
    const auto accepted = [](const Detection& d) { return d.accepted; };
    if (std::none_of(results[m].detections.begin(), results[m].detections.end(), accepted)) continue;
    const std::vector<OrientedPoint> none;
    const CandidateSearch search(scene, *models[m], none, options);
    for (size_t i = 0; i < results[m].detections.size(); ++i) {
      const Detection& detection = results[m].detections[i];
      if (!detection.accepted) continue;
      const PoseF pose{detection.camera_T_model.linear().cast<float>(),
                       detection.camera_T_model.translation().cast<float>()};
      claims.push_back({m, i, explained_cells(scene, models[m]->view(), pose, search.settings(pose).full)});
    }
  }
  // Who explains most goes first: a part that looks like a piece of another object explains less than that.
  std::stable_sort(claims.begin(), claims.end(),
                   [](const Claim& a, const Claim& b) { return a.cells.size() > b.cells.size(); });
  constexpr float kTaken = 0.6f;
  std::vector<std::string> better(results.size());
  for (size_t i = 0; i < claims.size(); ++i) {
    MatchResult& result = results[claims[i].model];
    for (size_t k = 0; k < i; ++k) {
      const MatchResult& other = results[claims[k].model];
      if (!other.detections[claims[k].detection].accepted || claims[k].model == claims[i].model) continue;
      if (overlap(claims[i].cells, claims[k].cells) < kTaken) continue;
      result.detections[claims[i].detection].accepted = false;
      better[claims[i].model] = models[claims[k].model]->name();
      break;
    }
  }
  for (size_t m = 0; m < results.size(); ++m) {
    if (better[m].empty()) continue;
    auto& detections = results[m].detections;
    std::stable_partition(detections.begin(), detections.end(),
                          [](const Detection& d) { return d.accepted; });
    if (!detections.front().accepted)
      results[m].reason = "what it would explain is explained better by " + better[m];
  }
}

}  // namespace edgepose
