#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "files/bop_results.h"
#include "files/test_set.h"
#include "matcher/match.h"

namespace edgepose {

struct EvalOptions {
  bool all_models = false;  ///< ask for every model in every image, not only for those the ground truth lists
  TrainOptions train;
  SceneOptions scene;
  MatchOptions match;
  double deadline = 0;  ///< [s] for each object in each image, all of the preprocessing included; 0 = none.
                        ///< Takes the place of match.max_seconds
  std::optional<int>
      threads;  ///< overrides those of the options above; 0 = all cores. Only times depend on it

  /// Applied to every depth image before it is preprocessed (the noise study); its time is not counted.
  std::function<DepthImage(const TestImage& image, const DepthImage& depth, const Camera& camera)> disturb;

  /// Empty if sound, else one line that names the bad field.
  std::string check() const;
};

/// A model of the set, trained.
struct TrainedModel {
  int object_id = 0;
  Model model;
  double seconds = 0;  ///< wall time of the training
};

/// What a report says of a trained model.
struct TrainingFacts {
  int object_id = 0;
  double diameter = 0;                      ///< [m]
  size_t points = 0, pairs = 0, bytes = 0;  ///< of the table
  double seconds = 0;
};
std::vector<TrainingFacts> facts_of(const std::vector<TrainedModel>& models);

/// The answer to "where is this object in this image?".
struct EvalRow {
  int scene_id = 0, image_id = 0, object_id = 0;
  bool found = false;  ///< the matcher gave a pose, accepted or not; without one, pose and score mean nothing
  bool accepted = false;   ///< ... and says that the object is there
  bool cut_short = false;  ///< deadline or MatchOptions::max_seconds ended the search
  double score = 0;
  RigidTransform camera_T_model = RigidTransform::Identity();  ///< in the frame of the ground truth
  double seconds = 0;        ///< wall time: matching, and this object's share of the preprocessing
  double preprocessing = 0;  ///< [s] that share
  StageTimes stages;
  std::string reason;  ///< why nothing was accepted
};

struct Evaluation {
  std::vector<EvalRow> rows;         ///< one per question asked, in the order of images and models
  double wall_seconds = 0;           ///< of preprocessing and matching; reading images and training left out
  double cpu_seconds = 0;            ///< of the same, all threads together
  double peak_memory_megabytes = 0;  ///< of the process so far, training included
};

/// Trains every object of `set`. Throws InputError if the options are unsound or a mesh cannot be used.
std::vector<TrainedModel> train_models(const TestSet& set, const EvalOptions& options,
                                       const Progress& progress = {});

/// Whether an evaluation asks for this object in this image: those that the ground truth lists, or all.
bool is_asked(const TestImage& image, int object_id, bool all_models);

/// Asks `models` for their poses in the images of `set`. Models of one image share its preprocessing.
/// Throws InputError if the options are unsound or an image cannot be read.
Evaluation run_evaluation(const TestSet& set, const std::vector<TrainedModel>& models,
                          const EvalOptions& options, const Progress& progress = {});

/// Rows of a BOP result file: those with a pose; with `only_accepted`, those the matcher stands for.
std::vector<BopResult> to_bop_results(const std::vector<EvalRow>& rows, bool only_accepted);

/// The other way, for scoring a result file of any origin; every row counts as accepted.
std::vector<EvalRow> from_bop_results(const std::vector<BopResult>& results);

}  // namespace edgepose
