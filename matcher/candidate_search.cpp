#include "matcher/candidate_search.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "matcher/clustering.h"
#include "matcher/parallel.h"
#include "matcher/sightings.h"
#include "matcher/stopwatch.h"

namespace edgepose {
namespace {

// Dense points that are looked at: of a pose just voted for, refined coarsely, refined finely, reported.
constexpr size_t kQuickPoints = 200, kMiddlePoints = 400, kFullPoints = 1500, kAllPoints = 1 << 20;
constexpr float kLikeDistance = 0.02f, kLikeAngle = 0.05f;  // [d], [rad] poses closer than this are one

/// How many of the first `limit` dense points a view shows, for a view that shows much (90th percentile).
float typical_points(const Model::View& model, size_t limit) {
  std::vector<int> counts;
  for (size_t v = 0; v < model.view_directions.size(); ++v) {
    int count = 0;
    for (size_t w = 0; w < std::min(model.words_per_view(), limit / 64 + 1); ++w)
      count += std::popcount(model.visible_from(v)[w]);
    counts.push_back(count);
  }
  std::sort(counts.begin(), counts.end());
  return std::max(1.f, static_cast<float>(counts[counts.size() * 9 / 10]));
}

void rank(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
}

/// A wrong pose seldom wins in several batches, so the more have led to it, the less sure it must be.
bool beyond_doubt(const Candidate& best, const SearchOptions& options) {
  const float sure = best.sightings == 1   ? options.sure_once
                     : best.sightings == 2 ? options.sure_twice
                                           : options.sure_thrice;
  return best.confidence > sure;
}

/// Keeps the best `count` by score and as many more by surface; ranked.
void keep_promising(std::vector<Candidate>& candidates, size_t count) {
  if (candidates.size() <= 2 * count) return rank(candidates);
  rank(candidates);
  std::stable_sort(candidates.begin() + static_cast<long>(count), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.surface > b.surface; });
  candidates.resize(2 * count);
  rank(candidates);
}

/// Keeps the best of each group of poses that nearly coincide.
void merge_like(std::vector<Candidate>& ranked, const PoseComparison& comparison) {
  std::vector<Candidate> kept;
  for (const Candidate& c : ranked) {
    const auto like = std::find_if(kept.begin(), kept.end(), [&](const Candidate& k) {
      return comparison.alike(k.pose, c.pose, kLikeDistance, kLikeAngle);
    });
    if (like == kept.end()) kept.push_back(c);
  }
  ranked = std::move(kept);
}

}  // namespace

CandidateSearch::CandidateSearch(const Scene::Data& scene, const Model& model,
                                 const std::vector<OrientedPoint>& points, const MatchOptions& options)
    : scene_(scene),
      model_(model),
      points_(points),
      partners_(points, static_cast<float>(model.diameter())),
      comparison_(model),
      options_(options) {
  const Model::View& view = model.view();
  const std::array<float, 3> typical = {typical_points(view, kQuickPoints),
                                        typical_points(view, kMiddlePoints),
                                        typical_points(view, kFullPoints)};
  for (int b = 0; b < NoiseCurve::kBins; ++b) settings_[b] = settings_for(scene.noise.sigma[b], typical);
}

std::vector<Candidate> CandidateSearch::run(const std::vector<uint32_t>& references,
                                            MatchResult& result) const {
  const Stopwatch watch;
  double last = 0;
  std::vector<Candidate> candidates;
  const auto size = static_cast<size_t>(options_.search.batch);
  const size_t batches = (references.size() + size - 1) / size;
  size_t looked = 0;
  while (looked < batches) {
    const size_t begin = looked * size, end = std::min(references.size(), begin + size);
    add_batch({references.begin() + static_cast<long>(begin), references.begin() + static_cast<long>(end)},
              candidates, result);
    ++looked;
    if (ends_search(candidates)) break;
    const double now = watch.total(), batch_seconds = now - std::exchange(last, now);
    const double used = result.times.sampling + now;
    // What follows the search, one pose refined with all points, takes about as long as a batch.
    if (options_.max_seconds > 0 && used + 2 * batch_seconds > options_.max_seconds && looked < batches) {
      result.cut_short = true;
      break;
    }
  }
  count_rounds(candidates, looked);
  return candidates;
}

bool CandidateSearch::ends_search(const std::vector<Candidate>& ranked) const {
  // More instances may come with more references.
  if (options_.max_instances != 1 || ranked.empty()) return false;
  const Candidate& best = ranked.front();
  if (beyond_doubt(best, options_.search)) return true;
  const auto sightings = static_cast<float>(best.sightings);
  if (best.sightings < 2) return false;
  return std::none_of(ranked.begin() + 1, ranked.end(), [&](const Candidate& c) {
    return sightings * (best.score - c.score) <= options_.search.settled &&
           !comparison_.same_answer(best.pose, c.pose);
  });
}

void CandidateSearch::count_rounds(std::vector<Candidate>& candidates, size_t looked) const {
  const auto references =
      static_cast<size_t>(options_.voting.reference_share * static_cast<float>(points_.size()));
  for (Candidate& c : candidates) {
    c.sightings = expected_rounds(c.sightings, looked, options_.search.batch, references);
    c.confidence = acceptance_score(c.evidence, settings(c.pose).full, c.sightings);
  }
}

Candidate CandidateSearch::finish(const PoseF& pose, float votes, int sightings) const {
  std::vector<Candidate> one(1);
  one[0].pose = pose;
  one[0].votes = votes;
  one[0].sightings = sightings;
  refine(one, &VerificationSettings::coarse_icp, &VerificationSettings::middle);
  refine(one, &VerificationSettings::fine_icp, &VerificationSettings::full);
  return one[0];
}

Candidate CandidateSearch::polish(const Candidate& candidate) const {
  std::vector<Candidate> one = {candidate};
  refine(one, &VerificationSettings::last_icp, &VerificationSettings::full);
  return one[0];
}

void CandidateSearch::add_batch(const std::vector<uint32_t>& references, std::vector<Candidate>& found,
                                MatchResult& result) const {
  Stopwatch watch;
  auto hypotheses = vote(model_, points_, partners_, references, options_.voting, options_.threads);
  result.times.voting += watch.lap();
  const auto clusters = cluster_poses(std::move(hypotheses), model_, options_.clustering);
  result.candidates += clusters.size();
  result.times.clustering += watch.lap();

  std::vector<Candidate> batch(clusters.size());
  constexpr size_t kAtOnce = 4;
  parallel_for((clusters.size() + kAtOnce - 1) / kAtOnce, options_.threads, [&](size_t job) {
    PoseWorkspace work;
    for (size_t i = job * kAtOnce; i < std::min(clusters.size(), job * kAtOnce + kAtOnce); ++i) {
      batch[i].pose = {clusters[i].rotation, clusters[i].translation};
      batch[i].votes = clusters[i].votes;
      // A few steps first: a pose just voted for is off by some hundredths of the diameter, too much to be
      // judged.
      if (options_.refinement.enabled)
        batch[i].pose =
            refine_pose(scene_, model_.view(), batch[i].pose, settings(batch[i].pose).first_icp, work)
                .camera_T_model;
      examine(batch[i], settings(batch[i].pose).quick, work.surface);
    }
  });
  keep_promising(batch, static_cast<size_t>(options_.search.coarse_candidates));
  result.times.verification += watch.lap();

  refine(batch, &VerificationSettings::coarse_icp, &VerificationSettings::middle);
  keep_promising(batch, static_cast<size_t>(options_.search.fine_candidates));
  refine(batch, &VerificationSettings::fine_icp, &VerificationSettings::full);
  merge_batch(found, batch);
  result.times.refinement += watch.lap();
}

VerificationSettings CandidateSearch::settings_for(float noise, const std::array<float, 3>& typical) const {
  const ToleranceOptions& t = options_.tolerance;
  const RefinementOptions& r = options_.refinement;
  const float d = static_cast<float>(model_.diameter());
  const float tolerance = std::min(t.surface * d + t.noise_factor * noise, t.max_surface * d);
  const float shallow = t.shallow_depth * d, cosine = t.min_normal_cosine;
  VerificationSettings s;
  s.quick = {2 * tolerance, shallow, d, typical[0], cosine - 0.1f, kQuickPoints, false};
  s.middle = {1.5f * tolerance, shallow, d, typical[1], cosine, kMiddlePoints, true};
  s.full = {tolerance, shallow, d, typical[2], cosine, kFullPoints, true};
  s.first_icp.max_points = kQuickPoints;
  s.first_icp.iterations = r.first_iterations;
  s.first_icp.max_distance = 0.08f * d;
  s.first_icp.min_distance = 0.05f * d;
  s.first_icp.outline = false;
  s.coarse_icp.max_points = kQuickPoints;
  s.coarse_icp.iterations = r.coarse_iterations;
  s.coarse_icp.max_distance = 0.06f * d;
  s.coarse_icp.min_distance = 0.02f * d + 2 * noise;
  s.coarse_icp.outline_stride = 3;
  s.coarse_icp.surface_sigma = std::max(noise, 0.002f * d);
  s.fine_icp = s.coarse_icp;
  s.fine_icp.outline_stride = 1;
  s.fine_icp.max_points = kFullPoints;
  s.fine_icp.iterations = r.fine_iterations;
  s.fine_icp.max_distance = 0.025f * d + 2 * noise;
  s.fine_icp.min_distance = 0.008f * d + 2 * noise;
  s.fine_icp.outline_sigma_pixels = r.outline_sigma;
  s.last_icp = s.fine_icp;
  s.last_icp.max_points = kAllPoints;
  s.last_icp.iterations = r.last_iterations;
  s.last_icp.max_distance = s.fine_icp.min_distance;
  return s;
}

void CandidateSearch::merge_batch(std::vector<Candidate>& found, const std::vector<Candidate>& batch) const {
  std::vector<bool> seen(found.size(), false);  // by this batch, which is one sighting, however often
  for (const Candidate& c : batch) {
    const auto like = std::find_if(found.begin(), found.end(), [&](const Candidate& f) {
      return comparison_.alike(f.pose, c.pose, kLikeDistance, kLikeAngle);
    });
    if (like == found.end()) {
      found.push_back(c);
      seen.push_back(true);
      continue;
    }
    const auto at = static_cast<size_t>(like - found.begin());
    const int sightings = like->sightings + (seen[at] ? 0 : 1);
    seen[at] = true;
    if (c.score > like->score) *like = c;
    like->sightings = sightings;
    like->confidence = acceptance_score(like->evidence, settings(like->pose).full, sightings);
  }
  rank(found);
}

const VerificationSettings& CandidateSearch::settings(const PoseF& pose) const {
  const Eigen::Vector3f centre = pose * box_centre(*model_.view().header);
  return settings_[NoiseCurve::bin(centre.z())];
}

void CandidateSearch::examine(Candidate& c, const FreeSpaceOptions& how, PosedSurface& surface) const {
  c.evidence = examine_pose(scene_, model_.view(), c.pose, how, surface);
  c.score = rank_score(c.evidence, how);
  c.surface = surface_score(c.evidence, how);
}

void CandidateSearch::refine(std::vector<Candidate>& candidates, IcpOptions VerificationSettings::*icp,
                             FreeSpaceOptions VerificationSettings::*how) const {
  parallel_for(candidates.size(), options_.threads, [&](size_t i) {
    const VerificationSettings& s = settings(candidates[i].pose);
    PoseWorkspace work;
    if (options_.refinement.enabled) {
      candidates[i].icp = refine_pose(scene_, model_.view(), candidates[i].pose, s.*icp, work);
      candidates[i].pose = candidates[i].icp.camera_T_model;
    }
    examine(candidates[i], s.*how, work.surface);
    candidates[i].confidence = acceptance_score(candidates[i].evidence, s.*how, candidates[i].sightings);
  });
  rank(candidates);
  merge_like(candidates, comparison_);
}

}  // namespace edgepose
