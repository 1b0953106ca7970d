#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "evaluation/evaluate.h"
#include "evaluation/pose_error.h"

namespace edgepose {

/// Zeta of the paper: a pose is correct if its error is below this share of the object's diameter.
inline constexpr std::array<double, 3> kThresholds = {0.02, 0.05, 0.1};
/// Instances of which the camera sees less are not counted.
inline constexpr int kMinVisiblePixels = 150;

/// One instance of the ground truth that counts, and what was answered.
struct InstanceScore {
  int scene_id = 0, image_id = 0, object_id = 0;
  double visible = 1;      ///< [0, 1] share of its pixels that nothing covers
  double diameter = 0;     ///< [m]
  double error = 0;        ///< [m] ADD, or ADI' if the object has symmetries; infinite if there is no answer
  bool symmetric = false;  ///< the error is ADI'
  bool accepted = false;
  bool correct(double threshold) const { return error < threshold * diameter; }
};

/// Recall of a group of instances.
struct Recall {
  size_t instances = 0;
  std::array<size_t, kThresholds.size()> correct{};           ///< at kThresholds
  std::array<size_t, kThresholds.size()> correct_accepted{};  ///< ... and accepted
  double rate(size_t threshold) const;                        ///< [0, 1]; 0 for no instances
  void add(const InstanceScore& instance);
};

struct TimeFigures {
  size_t count = 0;
  double median = 0, mean = 0, p95 = 0;  ///< [s]
};

struct Scores {
  std::vector<InstanceScore> instances;
  std::map<int, Recall> objects;                         ///< RR, by object id
  Recall pooled;                                         ///< all instances together
  Recall best_guesses;                                   ///< the same, answers that are not accepted included
  std::array<double, kThresholds.size()> mean_recall{};  ///< [0, 1] MR: mean of RR over the objects
  size_t absent_pairs = 0;                               ///< pairs of image and object that is not in it
  size_t false_positives = 0;                            ///< ... in which the object was reported
  double median_error = 0;                               ///< [m] ADD or ADI' of the poses correct at 0.05 d
  double median_add = 0;  ///< [m] the same for objects without symmetries; 0 if there is none
  TimeFigures time;       ///< of every question asked
};

/// Errors of the poses of every object of a set; reading the meshes takes a moment, so make it once.
using PoseErrors = std::map<int, PoseError>;
PoseErrors make_pose_errors(const TestSet& set);

/// Scores answers by the paper's measures: the answer with the best score for each image and object.
/// Answers to what `set` does not hold are ignored. With `only_accepted`, others count as no answer; false
/// positives are counted among the accepted ones in any case.
Scores score_results(const TestSet& set, const PoseErrors& errors, const std::vector<EvalRow>& rows,
                     bool only_accepted = false);

/// Recall by image number modulo `modulo` (the three subsets of a spine set, say).
std::vector<Recall> recall_by_image_modulo(const Scores& scores, int modulo);

}  // namespace edgepose
