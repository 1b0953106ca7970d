#pragma once
#include <array>
#include <vector>

#include "matcher/free_space.h"
#include "matcher/icp.h"
#include "matcher/match.h"
#include "matcher/pose_comparison.h"
#include "matcher/voting.h"

namespace edgepose {

/// A pose on its way through verification and refinement.
struct Candidate {
  PoseF pose;  ///< camera_T_model
  float votes = 0;
  float score = 0;       ///< orders candidates (rank_score)
  float surface = 0;     ///< orders them by how much surface there is
  float confidence = 0;  ///< [0, 1]
  int sightings = 1;     ///< batches of references that led to it, each by itself; after run() rounds of 75
  IcpResult icp;
  FreeSpaceEvidence evidence;
};

/// How candidates are looked at and refined, from the quick look to the final one; follows the noise where
/// the candidate is.
struct VerificationSettings {
  FreeSpaceOptions quick, middle, full;
  IcpOptions first_icp, coarse_icp, fine_icp, last_icp;
};

/// The search of the default mode: votes, clusters, verifies and refines for a batch of references after the
/// other, and keeps what comes out ranked (docs/matcher.md).
class CandidateSearch {
 public:
  /// `points`: the sampled scene. All arguments must outlive the search.
  CandidateSearch(const Scene::Data& scene, const Model& model, const std::vector<OrientedPoint>& points,
                  const MatchOptions& options);

  /// Looks for all `references` (indices into points), or until a candidate is beyond doubt or settled, or
  /// the time (MatchOptions::max_seconds, sampling included) is up.
  std::vector<Candidate> run(const std::vector<uint32_t>& references, MatchResult& result) const;

  /// Refines one pose coarsely and finely, and looks at it in full.
  Candidate finish(const PoseF& pose, float votes, int sightings = 1) const;

  /// Refines what is to be reported once more, with every point of the model.
  Candidate polish(const Candidate& candidate) const;

  const VerificationSettings& settings(const PoseF& pose) const;

 private:
  void add_batch(const std::vector<uint32_t>& references, std::vector<Candidate>& found,
                 MatchResult& result) const;
  /// Whether the best candidate is beyond doubt, or clearly ahead of all others after several sightings.
  bool ends_search(const std::vector<Candidate>& ranked) const;
  /// Turns sightings in batches into the rounds of references that acceptance_score() knows.
  void count_rounds(std::vector<Candidate>& candidates, size_t looked) const;
  /// Adds what a batch found to what the batches before it did.
  void merge_batch(std::vector<Candidate>& found, const std::vector<Candidate>& batch) const;
  VerificationSettings settings_for(float noise, const std::array<float, 3>& typical) const;
  void examine(Candidate& c, const FreeSpaceOptions& how, PosedSurface& surface) const;
  void refine(std::vector<Candidate>& candidates, IcpOptions VerificationSettings::*icp,
              FreeSpaceOptions VerificationSettings::*how) const;

  const Scene::Data& scene_;
  const Model& model_;
  const std::vector<OrientedPoint>& points_;
  PartnerSearch partners_;
  PoseComparison comparison_;
  const MatchOptions& options_;
  std::array<VerificationSettings, NoiseCurve::kBins> settings_;  // by depth
};

}  // namespace edgepose
