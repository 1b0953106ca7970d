#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "matcher/match_options.h"
#include "matcher/model.h"
#include "matcher/scene.h"

namespace edgepose {

/// Wall time of each stage, seconds.
struct StageTimes {
  double sampling = 0, voting = 0, clustering = 0, verification = 0, refinement = 0;
  double total() const { return sampling + voting + clustering + verification + refinement; }
};

struct Detection {
  RigidTransform camera_T_model = RigidTransform::Identity();
  double score = 0;  ///< [0, 1] how sure; accepted if >= MatchOptions::accept_score
  bool accepted = false;
  /// [0, 1] S of the paper's Eq. 2; in paper mode, and where MatchOptions::edge_score asks for it.
  std::optional<double> edge_score;
  double coverage = 0;    ///< [0, 1] share of the surface expected from this view that the scene shows
  double violations = 0;  ///< [0, 1] share of the expected surface that the scene sees through
  double margin = 0;  ///< score minus the best score of a clearly different pose that is not reported itself;
                      ///< negative if that one has the higher score but explains less. Paper mode: the score
  double votes = 0;
  int sightings =
      1;  ///< rounds of 75 references that lead to it, each by itself; estimated if the search ended early
  /// Covariance of (rotation vector, translation) of a left perturbation exp(x) * camera_T_model about the
  /// model's centre; rad^2, rad m, m^2. From the ICP's normal equations.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Other poses that look the same: the model's symmetries. Continuous ones are in Model::symmetries().
  std::vector<RigidTransform> equivalent;
};

struct MatchResult {
  std::vector<Detection> detections;  ///< best first; may hold one that is not accepted (the best guess)
  std::string reason;                 ///< why nothing was accepted; empty if something was
  bool cut_short = false;             ///< MatchOptions::max_seconds ended the search
  StageTimes times;
  size_t scene_points = 0, reference_points = 0, candidates = 0;
};

/// Finds `model` in `scene` (paper Sec. 4.3, Fig. 2 g-i).
MatchResult match(const Scene& scene, const Model& model, const MatchOptions& options = {});

/// After several models were looked for in one scene (results[i] belongs to models[i]): where two detections
/// explain the same part of the image, only the one that explains more stays accepted. Those that are not go
/// behind those that are; `reason` is set where none is left. `options` as for match(); nothing happens in
/// the paper's modes, which always answer with a pose.
void resolve_conflicts(const Scene& scene, const std::vector<const Model*>& models,
                       const MatchOptions& options, std::vector<MatchResult>& results);

}  // namespace edgepose
