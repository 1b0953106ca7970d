#include "evaluation/score.h"

#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>

#include "common/error.h"
#include "evaluation/statistics.h"
#include "files/mesh_file.h"

namespace edgepose {
namespace {

using Question = std::tuple<int, int, int>;  // scene, image, object
using Answers = std::map<Question, const EvalRow*>;

/// The best answer to each question; the first of equals.
Answers best_answers(const std::vector<EvalRow>& rows, bool only_accepted) {
  Answers best;
  for (const EvalRow& row : rows) {
    if (!row.found || (only_accepted && !row.accepted)) continue;
    const EvalRow*& slot = best[{row.scene_id, row.image_id, row.object_id}];
    if (!slot || row.score > slot->score) slot = &row;
  }
  return best;
}

InstanceScore score_instance(const TestImage& image, const GroundTruth& truth, const TestObject& object,
                             const PoseError& error, const EvalRow* answer) {
  InstanceScore score;
  score.scene_id = image.scene_id;
  score.image_id = image.image_id;
  score.object_id = object.id;
  score.visible = truth.visible_share;
  score.diameter = object.diameter;
  score.symmetric = error.symmetric();
  score.error =
      answer ? error(truth.camera_T_model, answer->camera_T_model) : std::numeric_limits<double>::infinity();
  score.accepted = answer && answer->accepted;
  return score;
}

std::vector<InstanceScore> score_instances(const TestSet& set, const PoseErrors& errors,
                                           const Answers& answers) {
  std::map<int, const TestObject*> objects;
  for (const TestObject& object : set.objects) objects[object.id] = &object;
  std::vector<InstanceScore> instances;
  for (const TestImage& image : set.images)
    for (const GroundTruth& truth : image.truth) {
      const auto object = objects.find(truth.object_id);
      if (object == objects.end() || truth.visible_pixels < kMinVisiblePixels) continue;
      const auto answer = answers.find({image.scene_id, image.image_id, truth.object_id});
      instances.push_back(score_instance(image, truth, *object->second, errors.at(truth.object_id),
                                         answer == answers.end() ? nullptr : answer->second));
    }
  return instances;
}

/// All pairs of image and object, and those where the object is there.
struct Pairs {
  std::set<Question> all, present;
};

Pairs pairs_of(const TestSet& set) {
  Pairs pairs;
  for (const TestImage& image : set.images) {
    for (const TestObject& object : set.objects)
      pairs.all.insert({image.scene_id, image.image_id, object.id});
    for (const GroundTruth& truth : image.truth) {
      const Question question{image.scene_id, image.image_id, truth.object_id};
      if (pairs.all.count(question)) pairs.present.insert(question);
    }
  }
  return pairs;
}

double median_error_of_correct(const std::vector<InstanceScore>& instances, bool with_symmetric) {
  std::vector<double> errors;
  for (const InstanceScore& i : instances)
    if (i.correct(0.05) && (with_symmetric || !i.symmetric)) errors.push_back(i.error);
  return median(errors);
}

}  // namespace

double Recall::rate(size_t threshold) const {
  return instances ? static_cast<double>(correct[threshold]) / static_cast<double>(instances) : 0;
}

void Recall::add(const InstanceScore& instance) {
  ++instances;
  for (size_t k = 0; k < kThresholds.size(); ++k) {
    if (!instance.correct(kThresholds[k])) continue;
    ++correct[k];
    if (instance.accepted) ++correct_accepted[k];
  }
}

PoseErrors make_pose_errors(const TestSet& set) {
  PoseErrors errors;
  for (const TestObject& object : set.objects) {
    const Mesh mesh = read_mesh(object.mesh);
    errors.emplace(object.id, PoseError(mesh, object.symmetric));
  }
  return errors;
}

Scores score_results(const TestSet& set, const PoseErrors& errors, const std::vector<EvalRow>& rows,
                     bool only_accepted) {
  Scores scores;
  scores.instances = score_instances(set, errors, best_answers(rows, only_accepted));
  for (const InstanceScore& instance : scores.instances) {
    scores.objects[instance.object_id].add(instance);
    scores.pooled.add(instance);
  }
  for (const InstanceScore& instance : score_instances(set, errors, best_answers(rows, false)))
    scores.best_guesses.add(instance);
  for (size_t k = 0; k < kThresholds.size(); ++k) {
    std::vector<double> rates;
    for (const auto& [id, recall] : scores.objects) rates.push_back(recall.rate(k));
    scores.mean_recall[k] = mean(rates);
  }
  const Pairs pairs = pairs_of(set);
  scores.absent_pairs = pairs.all.size() - pairs.present.size();
  for (const auto& [question, answer] : best_answers(rows, true))
    scores.false_positives += pairs.all.count(question) && !pairs.present.count(question);
  std::vector<double> seconds;
  for (const EvalRow& row : rows)
    if (row.seconds > 0 && pairs.all.count({row.scene_id, row.image_id, row.object_id}))
      seconds.push_back(row.seconds);
  scores.time = {seconds.size(), median(seconds), mean(seconds), percentile(seconds, 0.95)};
  scores.median_error = median_error_of_correct(scores.instances, true);
  scores.median_add = median_error_of_correct(scores.instances, false);
  return scores;
}

std::vector<Recall> recall_by_image_modulo(const Scores& scores, int modulo) {
  if (modulo < 1)
    throw std::invalid_argument("group-by-modulo: expected 1 or more, found " + std::to_string(modulo));
  std::vector<Recall> groups(static_cast<size_t>(modulo));
  for (const InstanceScore& instance : scores.instances)
    groups[static_cast<size_t>(instance.image_id % modulo)].add(instance);
  return groups;
}

}  // namespace edgepose
