#include "bench/speed/speed_run.h"

#include <algorithm>

#include "common/error.h"
#include "common/naming.h"
#include "evaluation/deadline.h"
#include "matcher/stopwatch.h"
#include "matcher/track.h"

namespace edgepose::bench {
namespace {

std::vector<Question> questions_of(const TestSet& set, const std::vector<ImageInput>& images) {
  std::vector<Question> questions;
  for (size_t i = 0; i < set.images.size(); ++i) {
    const std::vector<GroundTruth>& truth = set.images[i].truth;
    for (size_t m = 0; m < set.objects.size(); ++m) {
      const auto first = std::find_if(truth.begin(), truth.end(),
                                      [&](const GroundTruth& t) { return t.object_id == set.objects[m].id; });
      if (first != truth.end())
        questions.push_back({i, m, images[i].truth_T_camera.inverse() * first->camera_T_model});
    }
  }
  return questions;
}

}  // namespace

SpeedRun prepare_run(TestSet set, int threads) {
  SpeedRun run;
  run.set = std::move(set);
  run.threads = threads;
  for (const TestImage& image : run.set.images) run.images.push_back(read_image_input(image));
  run.questions = questions_of(run.set, run.images);
  if (run.questions.empty())
    throw InputError::at(run.set.name, "objects that the ground truth lists in the images", "none");
  EvalOptions options;
  options.threads = threads;
  run.models = train_models(run.set, options);
  run.errors = make_pose_errors(run.set);
  run.curves = CurveFile(run.set.name);
  return run;
}

Scene prepare(const ImageInput& image, int threads) {
  SceneOptions options;
  options.threads = threads;
  return naming(image.file, [&] { return prepare_scene(image.depth, image.camera, options); });
}

ImageInput cropped(const SpeedRun& run, const Question& question, const RigidTransform& camera_T_model,
                   float margin) {
  ImageInput image = run.images[question.image];
  const ImageWindow window = window_around(run.models[question.model].model, camera_T_model, image.camera,
                                           image.depth.width, image.depth.height, margin);
  if (window.empty()) return image;
  image.depth = cut_out(image.depth, window);
  image.camera = cut_out(image.camera, window);
  return image;
}

Answer ask(const ImageInput& image, const Model& model, const Asking& asking) {
  Answer answer;
  Stopwatch watch;
  const Scene scene = prepare(image, asking.threads);
  answer.preprocessing = watch.lap();
  MatchOptions options = within_deadline(asking.match, asking.deadline, answer.preprocessing);
  options.threads = asking.threads;
  answer.result = naming(image.file, [&] { return match(scene, model, options); });
  answer.matching = watch.lap();
  return answer;
}

EvalRow row_of(const SpeedRun& run, const Question& question, const Answer& answer) {
  const TestImage& image = run.set.images[question.image];
  EvalRow row;
  row.scene_id = image.scene_id;
  row.image_id = image.image_id;
  row.object_id = run.models[question.model].object_id;
  row.seconds = answer.seconds();
  row.preprocessing = answer.preprocessing;
  row.cut_short = answer.result.cut_short;
  if (answer.result.detections.empty()) return row;
  const Detection& best = answer.result.detections.front();
  row.found = true;
  row.accepted = best.accepted;
  row.score = best.score;
  row.camera_T_model = run.images[question.image].truth_T_camera * best.camera_T_model;
  return row;
}

Recall recall_of(const SpeedRun& run, const std::vector<EvalRow>& rows) {
  return score_results(run.set, run.errors, rows).best_guesses;
}

}  // namespace edgepose::bench
