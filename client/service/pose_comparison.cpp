#include "client/service/pose_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "client/service/answer_pairs.h"

namespace edgepose {
namespace {

double distance(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation() - b.translation()).norm();
}

/// `pose`, or the pose that looks the same and is turned least against `other`.
RigidTransform nearest_equivalent(const LoggedPose& pose, const RigidTransform& other) {
  RigidTransform nearest = pose.camera_T_model;
  for (const RigidTransform& candidate : pose.equivalent)
    if (angle_between(candidate, other) < angle_between(nearest, other)) nearest = candidate;
  return nearest;
}

void compare_pose(const LoggedPose& a, const LoggedPose& b, ModelComparison& model) {
  ++model.poses;
  if (same_bits(a, b)) {
    ++model.bit_equal;
    model.translation.push_back(0);
    model.rotation.push_back(0);
    return;
  }
  const RigidTransform near = nearest_equivalent(b, a.camera_T_model);
  model.translation.push_back(distance(a.camera_T_model, near));
  model.rotation.push_back(angle_between(a.camera_T_model, near));
}

void compare_model(const std::vector<LoggedPose>& a, const std::vector<LoggedPose>& b,
                   ModelComparison& model) {
  ++model.answers;
  std::vector<const LoggedPose*> left;
  left.reserve(b.size());
  for (const LoggedPose& pose : b) left.push_back(&pose);
  for (const LoggedPose& pose : a) {
    const auto near = std::min_element(left.begin(), left.end(), [&](const auto* p, const auto* q) {
      return distance(pose.camera_T_model, p->camera_T_model) <
             distance(pose.camera_T_model, q->camera_T_model);
    });
    if (near == left.end()) {
      ++model.only_a;
      continue;
    }
    compare_pose(pose, **near, model);
    left.erase(near);
  }
  model.only_b += left.size();
}

void compare_answer(const LoggedAnswer& a, const LoggedAnswer& b,
                    std::map<std::string, ModelComparison>& models) {
  static const std::vector<LoggedPose> kNone;
  std::set<std::string> names;
  for (const auto* answer : {&a, &b})
    for (const auto& [name, poses] : answer->models) names.insert(name);
  const auto of = [](const LoggedAnswer& answer, const std::string& name) -> const std::vector<LoggedPose>& {
    const auto found = answer.models.find(name);
    return found == answer.models.end() ? kNone : found->second;
  };
  for (const std::string& name : names) compare_model(of(a, name), of(b, name), models[name]);
}

}  // namespace

double angle_between(const RigidTransform& a, const RigidTransform& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

Comparison compare_logs(const AnswerLog& a, const AnswerLog& b) {
  Comparison result;
  for (const auto& [camera, of_a] : a.cameras) {
    const auto of_b = b.cameras.find(camera);
    if (of_b == b.cameras.end()) {
      result.only_a += of_a.answers.size();
      continue;
    }
    const AnswerPairs pairs = pair_answers(of_a.answers, of_b->second.answers);
    result.answers += pairs.both.size();
    result.only_a += pairs.only_a;
    result.only_b += pairs.only_b;
    for (const auto& [first, second] : pairs.both) {
      compare_answer(*first, *second, result.models);
      result.cut_short_a += first->cut_short;
      result.cut_short_b += second->cut_short;
    }
  }
  for (const auto& [camera, of_b] : b.cameras)
    if (!a.cameras.contains(camera)) result.only_b += of_b.answers.size();
  return result;
}

bool Comparison::nothing_missing() const {
  // Two logs in which nothing was found are not equal but empty.
  const bool any_pose =
      std::any_of(models.begin(), models.end(), [](const auto& m) { return m.second.poses > 0; });
  return answers > 0 && any_pose && only_a == 0 && only_b == 0 &&
         std::all_of(models.begin(), models.end(),
                     [](const auto& m) { return m.second.only_a == 0 && m.second.only_b == 0; });
}

bool Comparison::is_bit_equal() const {
  return nothing_missing() && std::all_of(models.begin(), models.end(),
                                          [](const auto& m) { return m.second.bit_equal == m.second.poses; });
}

bool Comparison::is_within(double translation, double rotation) const {
  const auto below = [](const std::vector<double>& values, double limit) {
    return std::all_of(values.begin(), values.end(), [=](double v) { return v <= limit; });
  };
  return nothing_missing() && std::all_of(models.begin(), models.end(), [&](const auto& m) {
           return below(m.second.translation, translation) && below(m.second.rotation, rotation);
         });
}

}  // namespace edgepose
