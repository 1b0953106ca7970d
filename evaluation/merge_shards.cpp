#include <algorithm>
#include <map>
#include <tuple>

#include "common/error.h"
#include "evaluation/shard.h"

namespace edgepose {
namespace {

constexpr size_t kMostNamed = 5;  // differences, missing parts: a line for people

/// "a, b and 3 more".
std::string listed(const std::vector<std::string>& items) {
  std::string text;
  const size_t shown = std::min(items.size(), kMostNamed);
  for (size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : ", ") + items[i];
  return text + (shown < items.size() ? " and " + std::to_string(items.size() - shown) + " more" : "");
}

std::vector<std::string> split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  size_t from = 0;
  for (size_t at; (at = text.find(separator, from)) != std::string::npos; from = at + separator.size())
    parts.push_back(text.substr(from, at - from));
  parts.push_back(text.substr(from));
  return parts;
}

/// Program, set and objects, then each option: what of `text` is not in `other`.
std::string only_in(const std::string& text, const std::string& other) {
  const auto items = [](const std::string& made_with) {
    std::vector<std::string> all = split(made_with, "; ");
    const std::vector<std::string> head = split(all.front(), ", ");
    all.erase(all.begin());
    all.insert(all.begin(), head.begin(), head.end());
    return all;
  };
  const std::vector<std::string> others = items(other);
  std::vector<std::string> only;
  for (const std::string& item : items(text))
    if (std::find(others.begin(), others.end(), item) == others.end()) only.push_back(item);
  return only.empty() ? "nothing else" : listed(only);
}

/// Each part once, all of one run.
void check_parts(const std::vector<ShardRun>& parts, const std::vector<std::string>& names) {
  if (parts.empty()) throw InputError::at("merge", "the shards of an evaluation", "none");
  const ShardRun& first = parts.front();
  std::map<int, std::string> seen;
  for (size_t i = 0; i < parts.size(); ++i) {
    const ShardRun& part = parts[i];
    if (part.shard.count != first.shard.count)
      throw InputError::at(names[i],
                           "one of " + std::to_string(first.shard.count) + " parts, as " + names.front(),
                           "one of " + std::to_string(part.shard.count));
    if (part.made_with != first.made_with)
      throw InputError::at(names[i], only_in(first.made_with, part.made_with) + ", as " + names.front(),
                           only_in(part.made_with, first.made_with),
                           "all parts need the same program, set and options");
    if (part.set_checksum != first.set_checksum)
      throw InputError::at(names[i],
                           "a part of the test set of " + names.front() + " (" + first.set_checksum + ")",
                           "one of a set with other files (" + part.set_checksum + ")",
                           "all machines need the same meshes, truth and images");
    const auto [other, is_new] = seen.emplace(part.shard.index, names[i]);
    if (!is_new)
      throw InputError::at(names[i], "each part once",
                           "part " + std::to_string(part.shard.index) + ", as " + other->second,
                           "leave one of them out");
  }
  std::vector<std::string> missing;
  for (int index = 1; index <= first.shard.count; ++index)
    if (!seen.contains(index)) missing.push_back(std::to_string(index));
  if (!missing.empty())
    throw InputError::at("merge", "all of " + std::to_string(first.shard.count) + " parts",
                         (missing.size() == 1 ? "no part " : "no parts ") + listed(missing),
                         "edgepose eval ... --shard " + missing.front() + "/" +
                             std::to_string(first.shard.count) + " writes such a part");
}

using Question = std::tuple<int, int, int>;  // scene, image, object

/// What a whole run asks, in its order.
std::vector<Question> questions_of(const TestSet& set, bool all_models) {
  std::vector<Question> questions;
  for (const TestImage& image : set.images)
    for (const TestObject& object : set.objects)
      if (is_asked(image, object.id, all_models))
        questions.emplace_back(image.scene_id, image.image_id, object.id);
  return questions;
}

}  // namespace

ShardRun merge_shards(const std::vector<ShardRun>& parts, const std::vector<std::string>& names,
                      const TestSet& set) {
  check_parts(parts, names);
  const std::string checksum = checksum_of(set);
  if (checksum != parts.front().set_checksum)
    throw InputError::at("merge", "the test set that the shards are of (" + parts.front().set_checksum + ")",
                         "a set " + set.name + " with other files (" + checksum + ")", "give it with --set");
  ShardRun whole = parts.front();
  whole.shard = {};
  whole.evaluation = {};
  std::map<Question, const EvalRow*> answers;
  for (size_t i = 0; i < parts.size(); ++i) {
    const Evaluation& part = parts[i].evaluation;
    whole.evaluation.wall_seconds += part.wall_seconds;
    whole.evaluation.cpu_seconds += part.cpu_seconds;
    whole.evaluation.peak_memory_megabytes =
        std::max(whole.evaluation.peak_memory_megabytes, part.peak_memory_megabytes);
    for (const EvalRow& row : part.rows)
      if (!answers.emplace(Question{row.scene_id, row.image_id, row.object_id}, &row).second)
        throw InputError::at(names[i], "one answer for each object in an image", "two",
                             "scene " + std::to_string(row.scene_id) + ", image " +
                                 std::to_string(row.image_id) + ", object " + std::to_string(row.object_id));
  }
  const std::vector<Question> questions = questions_of(set, whole.all_models);
  for (const auto& [scene, image, object] : questions) {
    const auto answer = answers.find({scene, image, object});
    if (answer == answers.end())
      throw InputError::at("merge",
                           "an answer for object " + std::to_string(object) + " in image " +
                               std::to_string(image) + " of scene " + std::to_string(scene),
                           "none", "is this the test set of the shards?");
    whole.evaluation.rows.push_back(*answer->second);
  }
  if (answers.size() != questions.size())
    throw InputError::at("merge", std::to_string(questions.size()) + " answers, as the test set asks",
                         std::to_string(answers.size()), "is this the test set of the shards?");
  return whole;
}

}  // namespace edgepose
