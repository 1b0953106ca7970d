// Teaching in the simulator: the true tool is led to places of the model, and the pose service looks.
#include <cmath>

#include "arm/rigid_motion.h"
#include "common/error.h"
#include "experiment/trial.h"
#include "servoing/teaching.h"
#include "simulator/starts.h"

namespace edgepose {
namespace {

constexpr size_t kOthers = 5;
constexpr int kMaxPlaces = 25;             // tried
constexpr int kPatience = 6;               // looks; then more than half must have found the model
constexpr double kMaxTilt = 0.45;          // [rad] of a landmark's axis from the target's
constexpr double kLeastDistance = 0.008;   // [m] of a landmark from the target and from each other
constexpr double kBefore = 0.01;           // [m] before a landmark, where the drill ...
constexpr double kLeastClearance = 0.002;  // [m] ... must be so far from the bone
constexpr int64_t kFramePeriod = 100'000;  // [us]
constexpr uint64_t kTeachingSeed = 0x7eac'4000'0000'0000;  // another day: other noise, another drift

/// Vertices of the model that a drill in about the target's direction can touch, drawn evenly.
class Landmarks {
 public:
  Landmarks(const WorkCell& cell, uint64_t seed)
      : cell_(cell), target_(cell.find_target(cell.target)), draws_(seed, DrawPurpose::kLandmarks) {}

  /// The next one; at least a little apart from the target and `taken`.
  DrillTarget draw(const std::vector<TaughtReference>& taken) {
    for (int tries = 0; tries < 100'000; ++tries) {
      const size_t i = draws_.bits() % cell_.model.vertices.size();
      DrillTarget place;
      place.name = "landmark " + std::to_string(taken.size() + 1);
      place.entry = cell_.model.vertices[i].cast<double>();
      place.axis = -cell_.model.normals[i].cast<double>().normalized();
      if (is_apart(place, taken) && can_be_touched(place)) return place;
    }
    throw InputError("experiment: expected a model with five places that the drill can touch, found fewer");
  }

 private:
  bool is_apart(const DrillTarget& place, const std::vector<TaughtReference>& taken) const {
    bool apart = (place.entry - target_.entry).norm() > kLeastDistance;
    for (const TaughtReference& other : taken)
      apart = apart && (place.entry - other.model_T_tool.translation()).norm() > kLeastDistance;
    return apart;
  }
  bool can_be_touched(const DrillTarget& place) const {
    if (!(std::acos(std::clamp(place.axis.dot(target_.axis), -1.0, 1.0)) < kMaxTilt)) return false;
    const RigidTransform before = cell_.base_T_model * model_T_tool_at(place, kBefore);
    return clearance(cell_, before) > kLeastClearance &&
           joints_for(cell_.arm,
                      cell_.base_T_model * model_T_tool_at(place, 0) * cell_.flange_T_tool.inverse(),
                      cell_.nominal);
  }

  const WorkCell& cell_;
  const DrillTarget& target_;
  RandomDraws draws_;
};

/// The true tool brought to the place, but for the touch's error; nothing if the model is not found from
/// there: whoever teaches then takes another place.
std::optional<TaughtReference> taught_at(const DrillTarget& place, const WorkCell& cell,
                                         const ExperimentArm& arm, int poses, RandomDraws& touch,
                                         MatcherFeed& feed, int64_t& utime, const TeachingNote& note) {
  TaughtReference reference;
  reference.name = place.name;
  reference.model_T_tool = model_T_tool_at(place, 0);
  const Eigen::Vector3d turn = touch.gauss(arm.touch_angle), shift = touch.gauss(arm.touch);
  const RigidTransform truly = reference.model_T_tool * rigid_transform(rotation_matrix(turn), shift);
  const auto joints =
      joints_for(cell.arm, cell.base_T_model * truly * cell.flange_T_tool.inverse(), cell.nominal);
  if (!joints) return std::nullopt;
  for (int looks = 0; static_cast<int>(reference.camera_T_model.size()) < poses; ++looks) {
    if (looks >= kPatience && 2 * static_cast<int>(reference.camera_T_model.size()) < looks)
      return std::nullopt;
    utime += kFramePeriod;
    if (note) note(place.name, static_cast<int>(reference.camera_T_model.size()));
    if (const auto pose = feed.pose(*joints, utime)) reference.camera_T_model.push_back(*pose);
  }
  return reference;
}

}  // namespace

TaughtTool taught_tool(const WorkCell& cell, const ModelHandle& model, const Camera& told,
                       const ExperimentArm& arm, uint64_t seed, int poses, const TeachingNote& note) {
  RandomDraws touch(seed, DrawPurpose::kTouch);
  Landmarks landmarks(cell, seed);
  CellCameraOptions camera;
  camera.seed = seed ^ kTeachingSeed;
  MatcherFeed feed(cell, model, told, camera);
  const size_t count = arm.goal == GoalKind::kTaughtOne ? 1 : kOthers;
  std::vector<TaughtReference> references;
  int64_t utime = 1'000'000;
  for (int tries = 0; references.size() < count && tries < kMaxPlaces; ++tries) {
    const DrillTarget place = count == 1 ? cell.find_target(cell.target) : landmarks.draw(references);
    if (auto taught = taught_at(place, cell, arm, poses, touch, feed, utime, note))
      references.push_back(std::move(*taught));
  }
  if (references.size() < count)
    throw InputError("experiment: expected " + std::to_string(count) +
                     " places from which the model is found, found " + std::to_string(references.size()));
  TeachingOptions options;
  options.min_references = static_cast<int>(references.size());
  options.min_poses = poses;
  return teach(references, options);
}

RigidTransform taught_camera_T_tool(const WorkCell& cell, const ModelHandle& model, const Camera& told,
                                    const ExperimentArm& arm, uint64_t seed, int poses) {
  return taught_tool(cell, model, told, arm, seed, poses).camera_T_tool;
}

}  // namespace edgepose
