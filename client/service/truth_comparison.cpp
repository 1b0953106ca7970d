#include "client/service/truth_comparison.h"

#include <algorithm>
#include <limits>
#include <set>

#include "client/service/symmetric_error.h"
#include "common/error.h"
#include "files/bop_set.h"
#include "files/number_text.h"

namespace edgepose {
namespace {

const TestObject& object_of(const TestSet& set, const std::string& model) {
  std::string known;
  for (const TestObject& object : set.objects) {
    if (object.name == model || object.mesh.stem() == model) return object;
    known += (known.empty() ? "" : ", ") + object.name;
  }
  throw InputError::at("model '" + model + "' of the answers",
                       "the name of an object of " + set.name + ": " + known, "another",
                       "edgepose models add FILE --name NAME gives a model such a name");
}

/// The objects that were asked for, by the answers' names.
std::map<std::string, const TestObject*> asked_objects(const CameraAnswers& answers, const TestSet& set) {
  std::map<std::string, const TestObject*> asked;
  for (const LoggedAnswer& answer : answers.answers)
    for (const auto& [model, poses] : answer.models)
      if (!asked.contains(model)) asked[model] = &object_of(set, model);
  return asked;
}

void compare_image(const TestImage& image, const TestObject& object, const std::vector<LoggedPose>& found,
                   const PoseError& error, TruthModel& model) {
  std::vector<const LoggedPose*> left;
  left.reserve(found.size());
  for (const LoggedPose& pose : found) left.push_back(&pose);
  for (const GroundTruth& truth : image.truth) {
    if (truth.object_id != object.id) continue;
    // What the camera hardly sees need not be found, but may be.
    const bool counts = truth.visible_pixels >= kMinVisiblePixels;
    model.instances += counts;
    const auto off = [&](const LoggedPose* pose) {
      return error(truth.camera_T_model, pose->camera_T_model);
    };
    const auto best = std::min_element(left.begin(), left.end(),
                                       [&](const auto* p, const auto* q) { return off(p) < off(q); });
    if (best == left.end()) continue;
    if (counts) {
      const SymmetricError moved =
          symmetric_error(object.symmetries, truth.camera_T_model, (*best)->camera_T_model);
      model.translation.push_back(moved.translation);
      model.rotation.push_back(moved.rotation);
      model.error.push_back(off(*best));
    }
    left.erase(best);
  }
  model.extra += left.size();
}

}  // namespace

size_t TruthModel::within(double share) const {
  return static_cast<size_t>(
      std::count_if(error.begin(), error.end(), [&](double e) { return e < share * diameter; }));
}

bool TruthComparison::all_within(double share) const {
  return answers > 0 && unanswered == 0 && std::all_of(models.begin(), models.end(), [&](const auto& m) {
           return m.second.within(share) == m.second.instances && m.second.extra == 0;
         });
}

TestSet read_truth(const std::filesystem::path& folder) {
  if (looks_like_bop(folder)) return read_bop_set(folder);
  std::error_code failure;
  const auto scene = std::filesystem::canonical(folder, failure);
  const auto number = identifier(scene.filename().string());
  const auto root = scene.parent_path().parent_path();
  if (failure || !number || !looks_like_bop(root))
    throw InputError::at(folder.string(), "a BOP set, or a scene folder in one (SET/test/NNNNNN)",
                         failure ? failure.message() : "another folder");
  TestSet set = read_bop_set(root);
  std::erase_if(set.images, [&](const TestImage& image) { return image.scene_id != *number; });
  if (set.images.empty()) throw InputError::at(folder.string(), "images with truth", "none");
  return set;
}

TruthComparison compare_with_truth(const CameraAnswers& answers, const TestSet& set,
                                   const PoseErrors& errors) {
  const auto asked = asked_objects(answers, set);
  TruthComparison result;
  for (const auto& [name, object] : asked)
    result.models[name] = {object->diameter, errors.at(object->id).symmetric(), 0, 0, {}, {}, {}};
  const int64_t first = answers.first_frame.value_or(answers.answers.front().sequence);
  std::set<int64_t> seen;
  for (const LoggedAnswer& answer : answers.answers) {
    int64_t index = 0;
    if (__builtin_sub_overflow(answer.sequence, first, &index) || index < 0 || !seen.insert(index).second)
      throw InputError::at("answers", "sequence numbers that rise from the first frame on", "others",
                           "record one run of edgepose send, from its start");
    const TestImage& image = set.images[static_cast<size_t>(index) % set.images.size()];
    ++result.answers;
    for (const auto& [model, poses] : answer.models) {
      const TestObject& object = *asked.at(model);
      compare_image(image, object, poses, errors.at(object.id), result.models[model]);
    }
  }
  result.unanswered = static_cast<size_t>(*seen.rbegin()) + 1 - seen.size();
  return result;
}

}  // namespace edgepose
