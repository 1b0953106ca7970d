#pragma once
#include <string>
#include <vector>

#include "bench/speed/curve_file.h"
#include "evaluation/evaluate.h"
#include "evaluation/image_input.h"
#include "evaluation/score.h"

namespace edgepose::bench {

/// "Where is this object in this image?", and the truth.
struct Question {
  size_t image = 0, model = 0;                                 ///< indices of SpeedRun::images and models
  RigidTransform camera_T_model = RigidTransform::Identity();  ///< true pose of its first instance
};

/// What is asked how often: the set as it is read once, and the options of the program.
struct SpeedRun {
  TestSet set;
  std::vector<ImageInput> images;  ///< as set.images
  std::vector<TrainedModel> models;
  std::vector<Question> questions;  ///< every object that the ground truth lists, in every image
  PoseErrors errors;
  CurveFile curves;

  int repeat = 3;
  int threads = 0;      ///< 0 = all cores
  int max_threads = 0;  ///< of the curve over threads; 0 = as many as there are cores
  int max_models = 50;  ///< of the curve over models
  double shift = 2e-3;  ///< [m] between tracking's start and the truth
  double turn = 0.035;  ///< [rad] likewise
  uint64_t seed = 1;    ///< of their directions
};

/// Reads the images of the set and trains its objects. Throws InputError.
SpeedRun prepare_run(TestSet set, int threads);

/// One question asked: preprocessing and matching, each whole.
struct Answer {
  double preprocessing = 0, matching = 0;  ///< [s] wall time
  MatchResult result;
  double seconds() const { return preprocessing + matching; }
};

/// How a question is asked. `deadline` [s]: as EvalOptions::deadline.
struct Asking {
  MatchOptions match;
  int threads = 0;
  double deadline = 0;
};

Answer ask(const ImageInput& image, const Model& model, const Asking& asking);

/// The answer as the evaluation has it. Several make recall_of().
EvalRow row_of(const SpeedRun& run, const Question& question, const Answer& answer);
/// Recall of all best guesses, accepted or not, as `edgepose eval` counts it.
Recall recall_of(const SpeedRun& run, const std::vector<EvalRow>& rows);

/// The part of the question's image that the object can cover at that pose, and `margin` [d] around it; all
/// of the image if that would be nothing.
ImageInput cropped(const SpeedRun& run, const Question& question, const RigidTransform& camera_T_model,
                   float margin);

/// Preprocesses, and says which file it was where that fails. Throws InputError.
Scene prepare(const ImageInput& image, int threads);

}  // namespace edgepose::bench
