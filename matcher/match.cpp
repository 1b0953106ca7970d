#include "matcher/match.h"

#include <algorithm>
#include <functional>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

#include "matcher/clustering.h"
#include "matcher/free_space.h"
#include "matcher/icp.h"
#include "matcher/model_block.h"
#include "matcher/parallel.h"
#include "matcher/scene_data.h"
#include "matcher/scene_sampling.h"
#include "matcher/voting.h"

#ifdef EDGEPOSE_LAB
std::function<void(const edgepose::PoseF&, const edgepose::FreeSpaceEvidence&, float, float)> lab_hook;
#endif
namespace edgepose {
namespace {

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

constexpr size_t kBatch = 150;             // references voted for before the next look at the candidates
constexpr size_t kCoarseCandidates = 40;   // of each batch that are refined coarsely ...
constexpr size_t kFineCandidates = 6;      // ... and finely
constexpr float kSureScore = 0.995f;        // ends the search
constexpr size_t kMinReferences = 450, kMaxReferences = 900;  // few suffice in a large scene, a small one needs more than its share

struct Candidate {
  PoseF pose;
  float votes = 0;
  float score = 0;       // orders candidates
  float surface = 0;     // orders them by how much surface there is
  float confidence = 0;  // [0, 1]
  IcpResult icp;
  FreeSpaceEvidence evidence;
};

void rank(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
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
void merge_like(std::vector<Candidate>& ranked, const Model& model, float distance, float angle) {
  const Eigen::Vector3f centre = model.centre().cast<float>();
  std::vector<Candidate> kept;
  for (const Candidate& c : ranked) {
    const bool like = std::any_of(kept.begin(), kept.end(), [&](const Candidate& k) {
      return (k.pose * centre - c.pose * centre).norm() < distance * static_cast<float>(model.diameter()) &&
             angle_between(k.pose.rotation, c.pose.rotation) < angle;
    });
    if (!like) kept.push_back(c);
  }
  ranked = std::move(kept);
}

/// How candidates are looked at and refined, from the quick look to the final one.
struct Settings {
  FreeSpaceOptions quick, middle, full;
  IcpOptions coarse_icp, fine_icp;
};

/// Votes, clusters, verifies and refines for some of the references, and ranks what comes out among the
/// candidates that there are.
class Search {
 public:
  Search(const Scene::Data& scene, const Model& model, const std::vector<OrientedPoint>& points,
         const MatchOptions& options)
      : scene_(scene), model_(model), points_(points), options_(options) {
    for (int b = 0; b < NoiseCurve::kBins; ++b) settings_[b] = settings_for(scene.noise.sigma[b]);
  }

  void add_batch(const std::vector<uint32_t>& references, std::vector<Candidate>& ranked, MatchResult& result) const {
    Stopwatch watch;
    VotingOptions voting;
    voting.threads = options_.threads;
    auto hypotheses = vote(model_, points_, references, voting);
    result.times.voting += watch.lap();
    const auto clusters = cluster_poses(std::move(hypotheses), model_, {});
    result.candidates += clusters.size();
    result.times.clustering += watch.lap();

    std::vector<Candidate> batch(clusters.size());
    parallel_for((clusters.size() + 31) / 32, options_.threads, [&](size_t job) {
      for (size_t i = job * 32; i < std::min(clusters.size(), job * 32 + 32); ++i) {
        batch[i].pose = {clusters[i].rotation, clusters[i].translation};
        batch[i].votes = clusters[i].votes;
        examine(batch[i], settings(batch[i]).quick);
      }
    });
    keep_promising(batch, kCoarseCandidates);
    result.times.verification += watch.lap();

    refine(batch, &Settings::coarse_icp, &Settings::middle);
    keep_promising(batch, kFineCandidates);
    refine(batch, &Settings::fine_icp, &Settings::full);
    ranked.insert(ranked.end(), batch.begin(), batch.end());
    rank(ranked);
    merge_like(ranked, model_, 0.02f, 0.05f);
    result.times.refinement += watch.lap();
  }

 private:
  /// How many of the first `limit` dense points a view shows, for a view that shows much (90th percentile).
  float typical_points(size_t limit) const {
    std::vector<float> counts;
    for (size_t v = 0; v < model_.view().view_directions.size(); ++v) {
      float count = 0;
      for_visible_points(model_.view(), v, limit, [&](size_t) { ++count; });
      counts.push_back(count);
    }
    std::sort(counts.begin(), counts.end());
    return std::max(1.f, counts[counts.size() * 9 / 10]);
  }
  Settings settings_for(float noise) const {
    const float d = static_cast<float>(model_.diameter());
    const float tolerance = std::min(0.012f * d + 2 * noise, 0.03f * d);
    Settings s;
    s.quick = {3 * tolerance, 0.1f * d, d, typical_points(150), 0.5f, 150, false};
    s.middle = {1.5f * tolerance, 0.1f * d, d, typical_points(400), 0.6f, 400, true};
    s.full = {tolerance, 0.1f * d, d, typical_points(1500), 0.6f, 1500, true};
    s.coarse_icp.max_points = 200;
    s.coarse_icp.iterations = 6;
    s.coarse_icp.max_distance = 0.06f * d;
    s.coarse_icp.min_distance = 0.02f * d + 2 * noise;
    s.coarse_icp.surface_sigma = std::max(noise, 0.002f * d);
    s.fine_icp = s.coarse_icp;
    s.fine_icp.max_points = 1500;
    s.fine_icp.iterations = 10;
    s.fine_icp.max_distance = 0.025f * d + 2 * noise;
    s.fine_icp.min_distance = 0.008f * d + 2 * noise;
    s.fine_icp.outline_sigma_pixels = 4;
    return s;
  }
  const Settings& settings(const Candidate& c) const {
    const Eigen::Vector3f centre = c.pose * box_centre(*model_.view().header);
    return settings_[NoiseCurve::bin(centre.z())];
  }
  void examine(Candidate& c, const FreeSpaceOptions& how) const {
    c.evidence = examine_pose(scene_, model_.view(), c.pose, how);
    c.score = rank_score(c.evidence, how);
    c.surface = surface_score(c.evidence, how);
    c.confidence = acceptance_score(c.evidence, how);
  }
  void refine(std::vector<Candidate>& candidates, IcpOptions Settings::*icp, FreeSpaceOptions Settings::*how) const {
    parallel_for(candidates.size(), options_.threads, [&](size_t i) {
      const Settings& s = settings(candidates[i]);
      candidates[i].icp = refine_pose(scene_, model_.view(), candidates[i].pose, s.*icp);
      candidates[i].pose = candidates[i].icp.camera_T_model;
      examine(candidates[i], s.*how);
    });
    rank(candidates);
    merge_like(candidates, model_, 0.02f, 0.05f);
  }

  const Scene::Data& scene_;
  const Model& model_;
  const std::vector<OrientedPoint>& points_;
  const MatchOptions& options_;
  std::array<Settings, NoiseCurve::kBins> settings_;  // by depth
};

std::vector<uint32_t> pick_references(const std::vector<SampledPoint>& points, float share, uint64_t seed) {
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937_64 generator(seed);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[generator() % i]);
  const auto wanted = static_cast<size_t>(std::ceil(share * static_cast<float>(order.size())));
  order.resize(std::min(order.size(), std::clamp(wanted, kMinReferences, kMaxReferences)));
  return order;
}

}  // namespace

std::string MatchOptions::check() const {
  if (!(reference_share > 0 && reference_share <= 1)) return "reference_share: expected above 0 and at most 1";
  if (max_instances < 1 || max_instances > 100) return "max_instances: expected 1 to 100";
  if (!(accept_score >= 0 && accept_score <= 1)) return "accept_score: expected 0 to 1";
  if (paper.candidates < 1 || paper.candidates > 1000) return "paper.candidates: expected 1 to 1000";
  if (!(paper.roi_scale >= 1 && paper.roi_scale <= 10)) return "paper.roi_scale: expected 1 to 10";
  return "";
}

MatchResult match(const Scene& scene_handle, const Model& model, const MatchOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw std::invalid_argument(fault);
  const Scene::Data& scene = scene_handle.data();
  const Model::View& view = model.view();
  const float d = static_cast<float>(model.diameter());
  MatchResult result;
  Stopwatch watch;

  SamplingOptions sampling;
  sampling.step = static_cast<float>(view.header->sampling_step);
  sampling.keep_edges = options.edge_sampling;
  sampling.max_pixel_size = d / 32;
  sampling.max_noise = 0.012f * d;
  auto sampled = sample_scene(scene, sampling);
  sampled = drop_large_planes(sampled, d, scene.noise, options.threads);
  std::vector<OrientedPoint> points;
  for (const SampledPoint& p : sampled) points.push_back(p.surface);
  result.scene_points = points.size();
  const auto references = pick_references(sampled, options.reference_share, options.seed);
  result.reference_points = references.size();
  result.times.sampling = watch.lap();

  std::vector<Candidate> candidates;
  const Search search(scene, model, points, options);
  for (size_t begin = 0; begin < references.size(); begin += kBatch) {
    const size_t size = std::min(kBatch, references.size() - begin);
    search.add_batch({references.begin() + static_cast<long>(begin), references.begin() + static_cast<long>(begin + size)},
                     candidates, result);
    if (!candidates.empty() && candidates.front().confidence > kSureScore) break;
  }
#ifdef EDGEPOSE_LAB
  if (lab_hook) for (auto& c : candidates) lab_hook(c.pose, c.evidence, c.score, c.icp.rms);
#endif

  for (size_t i = 0; i < candidates.size() && i < static_cast<size_t>(options.max_instances); ++i) {
    const Candidate& c = candidates[i];
    Detection detection;
    detection.camera_T_model.linear() = c.pose.rotation.cast<double>();
    detection.camera_T_model.translation() = c.pose.translation.cast<double>();
    detection.score = c.confidence;
    detection.accepted = c.confidence >= options.accept_score;
    detection.coverage = c.evidence.coverage();
    detection.violations = c.evidence.violation_share();
    detection.votes = c.votes;
    result.detections.push_back(detection);
  }
  return result;
}

}  // namespace edgepose
