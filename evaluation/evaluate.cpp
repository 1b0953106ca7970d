#include "evaluation/evaluate.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "common/error.h"
#include "common/naming.h"
#include "evaluation/deadline.h"
#include "evaluation/image_input.h"
#include "evaluation/resources.h"
#include "files/mesh_file.h"
#include "files/sound_mesh.h"

namespace edgepose {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void require_sound(const EvalOptions& options) {
  if (const std::string complaint = options.check(); !complaint.empty()) throw InputError(complaint);
}

/// The models to ask for in one image.
std::vector<const TrainedModel*> models_for(const TestImage& image, const std::vector<TrainedModel>& models,
                                            bool all_models) {
  std::vector<const TrainedModel*> asked;
  for (const TrainedModel& model : models)
    if (is_asked(image, model.object_id, all_models)) asked.push_back(&model);
  return asked;
}

/// A row without the answer, which comes after all models were asked.
EvalRow row_for(const TestImage& image, const TrainedModel& model) {
  EvalRow row;
  row.scene_id = image.scene_id;
  row.image_id = image.image_id;
  row.object_id = model.object_id;
  return row;
}

void fill_in(const MatchResult& result, EvalRow& row) {
  row.stages = result.times;
  row.reason = result.reason;
  row.cut_short = result.cut_short;
  if (result.detections.empty()) return;
  const Detection& best = result.detections.front();
  row.found = true;
  row.accepted = best.accepted;
  row.score = best.score;
  row.camera_T_model = best.camera_T_model;
}

/// Asks for all models of one image; adds rows and times.
void evaluate_image(const TestImage& image, const std::vector<const TrainedModel*>& asked,
                    const EvalOptions& options, Evaluation& evaluation) {
  ImageInput input = read_image_input(image);
  if (options.disturb) input.depth = options.disturb(image, input.depth, input.camera);
  const auto start = Clock::now();
  const double cpu_start = process_cpu_seconds();
  const std::string& file = input.file;
  const Scene scene = naming(file, [&] { return prepare_scene(input.depth, input.camera, options.scene); });
  const double spent = input.seconds + seconds_since(start);
  const double preprocessing = spent / static_cast<double>(asked.size());
  const MatchOptions match_options = within_deadline(options.match, options.deadline, spent);
  std::vector<EvalRow> rows;
  std::vector<MatchResult> results;
  std::vector<const Model*> models;
  for (const TrainedModel* model : asked) {
    const auto asked_at = Clock::now();
    results.push_back(naming(file, [&] { return match(scene, model->model, match_options); }));
    models.push_back(&model->model);
    rows.push_back(row_for(image, *model));
    rows.back().seconds = seconds_since(asked_at) + preprocessing;
    rows.back().preprocessing = preprocessing;
  }
  // Only where absent objects are asked for, too, do models compete for the same part of the image.
  const auto conflicts_at = Clock::now();
  if (options.all_models) resolve_conflicts(scene, models, options.match, results);
  const double share = seconds_since(conflicts_at) / static_cast<double>(asked.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    fill_in(results[i], rows[i]);
    rows[i].seconds += share;
    rows[i].camera_T_model = input.truth_T_camera * rows[i].camera_T_model;
    evaluation.rows.push_back(std::move(rows[i]));
  }
  evaluation.cpu_seconds += process_cpu_seconds() - cpu_start;
  evaluation.wall_seconds += input.seconds + seconds_since(start);
}

}  // namespace

std::string EvalOptions::check() const {
  if (threads && *threads < 0)
    return "threads: expected 0 (all cores) or more, found " + std::to_string(*threads);
  if (!(deadline >= 0 && deadline <= kLongestDeadline))
    return "deadline: expected 0 (none) to 3600 s, found " + std::to_string(deadline);
  for (const std::string& complaint : {train.check(), scene.check(), match.check()})
    if (!complaint.empty()) return complaint;
  return "";
}

std::vector<TrainedModel> train_models(const TestSet& set, const EvalOptions& options,
                                       const Progress& progress) {
  require_sound(options);
  TrainOptions train = options.train;
  if (options.threads) train.threads = *options.threads;
  const double count = static_cast<double>(set.objects.size());
  std::vector<TrainedModel> models;
  for (const TestObject& object : set.objects) {
    const double done = static_cast<double>(models.size());
    const Progress part = [&](double share) {
      if (progress) progress((done + share) / count);
    };
    const Mesh mesh = read_sound_mesh(object.mesh, LengthUnit::kMillimetre).mesh;
    const auto start = Clock::now();
    Model model = naming(object.mesh.string(),
                         [&] { return train_model(mesh, object.name, train, object.symmetries, part); });
    models.push_back({object.id, std::move(model), seconds_since(start)});
  }
  if (progress) progress(1);
  return models;
}

bool is_asked(const TestImage& image, int object_id, bool all_models) {
  return all_models || std::any_of(image.truth.begin(), image.truth.end(),
                                   [&](const GroundTruth& truth) { return truth.object_id == object_id; });
}

Evaluation run_evaluation(const TestSet& set, const std::vector<TrainedModel>& models,
                          const EvalOptions& given, const Progress& progress) {
  require_sound(given);
  EvalOptions options = given;
  if (options.threads) options.scene.threads = options.match.threads = *options.threads;
  Evaluation evaluation;
  size_t images_done = 0;
  for (const TestImage& image : set.images) {
    const auto asked = models_for(image, models, options.all_models);
    if (!asked.empty()) evaluate_image(image, asked, options, evaluation);
    if (progress) progress(static_cast<double>(++images_done) / static_cast<double>(set.images.size()));
  }
  evaluation.peak_memory_megabytes = peak_memory_megabytes();
  return evaluation;
}

std::vector<TrainingFacts> facts_of(const std::vector<TrainedModel>& models) {
  std::vector<TrainingFacts> facts;
  facts.reserve(models.size());
  for (const TrainedModel& m : models)
    facts.push_back({m.object_id, m.model.diameter(), m.model.point_count(), m.model.pair_count(),
                     m.model.block().size(), m.seconds});
  return facts;
}

std::vector<BopResult> to_bop_results(const std::vector<EvalRow>& rows, bool only_accepted) {
  std::vector<BopResult> results;
  for (const EvalRow& row : rows) {
    if (!row.found || (only_accepted && !row.accepted)) continue;
    BopResult result;
    result.scene_id = row.scene_id;
    result.image_id = row.image_id;
    result.object_id = row.object_id;
    result.score = row.score;
    result.camera_T_model = row.camera_T_model;
    result.time = row.seconds;
    results.push_back(result);
  }
  return results;
}

std::vector<EvalRow> from_bop_results(const std::vector<BopResult>& results) {
  std::vector<EvalRow> rows;
  for (const BopResult& result : results) {
    EvalRow row;
    row.scene_id = result.scene_id;
    row.image_id = result.image_id;
    row.object_id = result.object_id;
    row.found = row.accepted = true;
    row.score = result.score;
    row.camera_T_model = result.camera_T_model;
    row.seconds = result.time;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace edgepose
