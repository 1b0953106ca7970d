#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "matcher/model.h"
#include "matcher/scene.h"

namespace edgepose {

/// How the final pose is chosen among the candidates.
enum class Verification {
  kFreeSpace,  ///< ours: matches against free-space violations and edges, knows occlusion; can say "not here"
  kPaper,      ///< the paper's edge score S with two classes and early exit (Sec. 4.3.4); always gives a pose
  kSurfaceOverlap,  ///< share of model points near the scene (Papazov and Burschka), the paper's baseline
};

/// The paper's verification, Eq. 2 and the steps below it.
struct PaperOptions {
  int candidates = 9;      ///< N: poses of each class that get the detailed score
  float roi_scale = 1.4f;  ///< s: size of the region of interest relative to the candidate's bounding box
  float accept_at_once = 0.7f;  ///< S above which the search ends
  float accept_best = 0.6f;     ///< S above which the best of a class is taken
  float edge_distance = 0.02f;  ///< [d] a scene edge point this close to the posed model matches
  bool two_classes = true;      ///< false: all candidates in one class (first of the three ways of Fig. 10)
  bool early_exit = true;       ///< false: score all 2N (second way)
};

struct MatchOptions {
  Verification verification = Verification::kFreeSpace;
  PaperOptions paper;
  bool edge_sampling =
      true;  ///< keep edge and high-curvature points (paper Fig. 4); false = plain normal clusters
  float reference_share =
      0.2f;  ///< share of the scene points used as reference points (paper: 1/5); time grows with it
  int max_instances = 1;       ///< how many instances of the model to look for
  float accept_score = 0.66f;  ///< [0, 1] detections with a lower score are reported as not accepted
  bool refine = true;          ///< ICP
  uint64_t seed = 1;
  int threads = 0;  ///< 0 = all cores; the result does not depend on it

  std::string check() const;
};

/// Wall time of each stage, seconds.
struct StageTimes {
  double sampling = 0, voting = 0, clustering = 0, verification = 0, refinement = 0;
  double total() const { return sampling + voting + clustering + verification + refinement; }
};

struct Detection {
  RigidTransform camera_T_model = RigidTransform::Identity();
  double score = 0;  ///< [0, 1] how sure; accepted if >= MatchOptions::accept_score
  bool accepted = false;
  double edge_score = 0;  ///< S of the paper's Eq. 2
  double coverage = 0;    ///< [0, 1] share of the surface expected from this view that the scene shows
  double violations = 0;  ///< [0, 1] share of the expected surface that the scene sees through
  double margin = 0;      ///< score minus the score of the best clearly different pose
  double votes = 0;
  /// Covariance of (rotation vector, translation) of a left perturbation exp(x) * camera_T_model about the
  /// model's centre; rad^2, rad m, m^2. From the ICP's normal equations.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Other poses that look the same: the model's symmetries. Continuous ones are in Model::symmetries().
  std::vector<RigidTransform> equivalent;
};

struct MatchResult {
  std::vector<Detection> detections;  ///< best first; may hold one that is not accepted (the best guess)
  std::string reason;                 ///< why nothing was accepted; empty if something was
  StageTimes times;
  size_t scene_points = 0, reference_points = 0, candidates = 0;
};

/// Finds `model` in `scene` (paper Sec. 4.3, Fig. 2 g-i).
MatchResult match(const Scene& scene, const Model& model, const MatchOptions& options = {});

/// After several models were looked for in one scene (results[i] belongs to models[i]): where two detections
/// explain the same part of the image, only the one that explains more stays accepted. Changes `accepted` and
/// `reason` only.
void resolve_conflicts(const Scene& scene, const std::vector<const Model*>& models,
                       std::vector<MatchResult>& results);

}  // namespace edgepose
