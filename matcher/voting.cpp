#include "matcher/voting.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "matcher/bucket_visits.h"
#include "matcher/parallel.h"
#include "matcher/partner_search.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr int kAlphaBits = 5;  // 32 bins of 11.25 degrees
constexpr uint32_t kAlphaBins = 1u << kAlphaBits;
constexpr int kAlphaShift = 16 - kAlphaBits;
constexpr size_t kAhead = 12;  // visits between asking for a bucket and using it

/// The largest sum of two neighbouring entries of an accumulator's row.
EDGEPOSE_WIDE_SIMD uint32_t highest_pair(const uint16_t* row) {
  uint16_t highest = static_cast<uint16_t>(row[kAlphaBins - 1] + row[0]);
  for (uint32_t a = 0; a + 1 < kAlphaBins; ++a)
    highest = std::max(highest, static_cast<uint16_t>(row[a] + row[a + 1]));
  return highest;
}

/// The entries of a bucket that get a vote.
struct Hit {
  uint32_t begin, end;
  uint16_t alpha;
};

/// Everything one thread needs to vote for one reference after the other. Works through long lists step by
/// step instead of pair by pair, so that the table's cache lines are on their way before they are needed.
class Accumulator {
 public:
  /// `border` [bins]: how far votes spread.
  Accumulator(const Model& model, float border)
      : view_(model.view()), votes_(view_.points.size() * kAlphaBins), flags_(view_.offsets.size() - 1) {
    const ModelHeader& h = *view_.header;
    quantiser_ = {static_cast<float>(1 / h.distance_step),
                  static_cast<float>(h.angle_bins) / std::numbers::pi_v<float>, h.distance_bins,
                  h.angle_bins};
    rule_ = {static_cast<float>(h.diameter), border, h.normal_bin_first, h.normal_bin_last};
  }

  void vote_for(const PartnerSearch& partners, const OrientedPoint& reference) {
    std::fill(votes_.begin(), votes_.end(), uint16_t{0});
    const ReferenceFrame frame(reference);
    partners.runs_near(reference.position, runs_);
    for (const PartnerSearch::Run& run : runs_) {
      batch_.compute(reference, frame, partners.points(), run, quantiser_);
      visits_.list(batch_, run.second - run.first, quantiser_, rule_);
      list_hits();
      vote();
    }
    for (size_t i = 0; i < flagged_count_; ++i) flags_[flagged_[i]] = 0;
    flagged_count_ = 0;
  }

  /// The strongest (model point, alpha) entries as poses; the votes of two neighbouring alphas count
  /// together.
  void peaks(const OrientedPoint& reference, std::span<PoseHypothesis> best) const {
    struct Peak {
      uint32_t votes = 0, point = 0, alpha = 0;
    };
    std::vector<Peak> top(best.size());
    for (uint32_t m = 0; m < view_.points.size(); ++m) {
      const uint16_t* row = votes_.data() + size_t{m} * kAlphaBins;
      if (highest_pair(row) <= top.back().votes) continue;
      Peak peak{0, m, 0};
      for (uint32_t a = 0; a < kAlphaBins; ++a) {
        const uint32_t sum = uint32_t{row[a]} + row[(a + 1) & (kAlphaBins - 1)];
        if (sum > peak.votes) peak.votes = sum, peak.alpha = a;
      }
      top.back() = peak;
      for (size_t k = top.size() - 1; k > 0 && top[k].votes > top[k - 1].votes; --k)
        std::swap(top[k], top[k - 1]);
    }
    const ReferenceFrame scene_frame(reference);
    for (size_t k = 0; k < top.size(); ++k)
      best[k] = pose(scene_frame, top[k].point, top[k].alpha, top[k].votes);
  }

 private:
  /// Looks the buckets up. Like pairs at like alpha vote once (Hinterstoisser et al. 2016): planes and dense
  /// areas repeat them. What need not be kept is written all the same, as nobody could predict it.
  void list_hits() {
    const size_t visits = visits_.count();
    hits_.resize(visits + 1);
    flagged_.resize(flagged_count_ + visits + 1);
    const uint32_t* offsets = view_.offsets.data();
    size_t count = 0;
    for (size_t i = 0; i < visits; ++i) {
      const uint32_t ahead = visits_.bucket(std::min(i + kAhead, visits - 1));
      __builtin_prefetch(offsets + ahead);
      __builtin_prefetch(&flags_[ahead], 1);
      const uint32_t bucket = visits_.bucket(i), begin = offsets[bucket], end = offsets[bucket + 1];
      const uint16_t alpha = visits_.alpha(i);
      const uint32_t bit = 1u << (alpha >> kAlphaShift), flags = flags_[bucket];
      const bool fresh = (begin != end) & ((flags & bit) == 0);
      flags_[bucket] = fresh ? flags | bit : flags;
      flagged_[flagged_count_] = bucket;
      flagged_count_ += fresh & (flags == 0);
      __builtin_prefetch(&view_.entries[begin]);
      hits_[count] = {begin, end, alpha};
      count += fresh;
    }
    hits_.resize(count);
  }

  void vote() {
    const PairEntry* entries = view_.entries.data();
    uint16_t* votes = votes_.data();
    for (const Hit hit : hits_)
      for (const PairEntry *entry = entries + hit.begin, *end = entries + hit.end; entry != end; ++entry) {
        const uint32_t alpha = static_cast<uint16_t>(hit.alpha - entry->alpha) >> kAlphaShift;
        ++votes[(uint32_t{entry->reference} << kAlphaBits) + alpha];
      }
  }

  PoseHypothesis pose(const ReferenceFrame& scene_frame, uint32_t point, uint32_t alpha_bin,
                      uint32_t votes) const {
    const uint16_t* row = votes_.data() + size_t{point} * kAlphaBins;
    const float first = row[alpha_bin], second = row[(alpha_bin + 1) & (kAlphaBins - 1)];
    const float middle = static_cast<float>(alpha_bin) + 0.5f + second / std::max(1.f, first + second);
    const float alpha = middle * 2 * std::numbers::pi_v<float> / kAlphaBins;
    const ReferenceFrame model_frame(view_.points[point]);
    const Eigen::Matrix3f turn = Eigen::AngleAxisf(alpha, Eigen::Vector3f::UnitX()).toRotationMatrix();
    const Eigen::Matrix3f rotation = scene_frame.rotation.transpose() * turn * model_frame.rotation;
    return {rotation, scene_frame.origin - rotation * model_frame.origin, static_cast<float>(votes)};
  }

  const Model::View& view_;
  FeatureQuantiser quantiser_{};
  VisitRule rule_{};
  std::vector<uint16_t> votes_;
  std::vector<uint32_t> flags_, flagged_;  // flagged: the buckets with flags, flagged_count_ of them
  size_t flagged_count_ = 0;
  std::vector<PartnerSearch::Run> runs_;
  FeatureBatch batch_;
  BucketVisits visits_;
  std::vector<Hit> hits_;
};

}  // namespace

std::vector<PoseHypothesis> vote(const Model& model, const std::vector<OrientedPoint>& points,
                                 const PartnerSearch& partners, const std::vector<uint32_t>& references,
                                 const VotingOptions& options, int threads) {
  const size_t peaks = static_cast<size_t>(options.peaks_per_reference);
  std::vector<PoseHypothesis> hypotheses(references.size() * peaks);
  const size_t workers = std::min<size_t>(references.size(), static_cast<size_t>(thread_count(threads)));
  // Whoever is free takes the next reference: what it gives does not depend on that.
  std::atomic<size_t> next{0};
  parallel_for(workers, threads, [&](size_t) {
    if (next >= references.size()) return;  // a late thread would only clear an accumulator
    Accumulator accumulator(model, options.border);
    for (size_t i = next++; i < references.size(); i = next++) {
      accumulator.vote_for(partners, points[references[i]]);
      accumulator.peaks(points[references[i]], std::span(hypotheses).subspan(i * peaks, peaks));
    }
  });
  return hypotheses;
}

}  // namespace edgepose
