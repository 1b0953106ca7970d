#include "controller/pose_inbox.h"

#include <algorithm>
#include <utility>

#include "common/error.h"
#include "common/nearest_word.h"
#include "messaging/channels.h"
#include "messaging/checked_decode.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

constexpr double kMaxTargetAge = 1.0;       // [s] of the frame that shows the hole when go is said
constexpr int64_t kClockStep = 2'000'000;   // [ns] between two messages: more than clocks are slewed
constexpr int64_t kUnderWay = 400'000'000;  // [ns] that a frame may be on its way, as the gate's max_age
constexpr size_t kMaxTargets = 1000;        // of one model; more is no plan

/// Of the same hole in two frames: rounding only.
bool is_same(const ServoGoal& a, const ServoGoal& b) {
  return (a.entry - b.entry).norm() < 1e-5 && (a.axis - b.axis).norm() < 1e-4;
}

PoseReading reading_of(const edgepose_lcm::detection_t& detection, const RigidTransform& camera_T_model) {
  PoseReading reading;
  reading.camera_T_model = camera_T_model;
  reading.accepted = detection.accepted;
  reading.score = detection.score;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      reading.covariance(row, column) = detection.covariance[row][column];
  return reading;
}

/// The hole in the model's frame; nothing if its numbers are none.
std::optional<SeenTarget> seen_target(const edgepose_lcm::drill_target_t& message,
                                      const RigidTransform& model_T_camera, double capture_time) {
  SeenTarget seen;
  seen.hole.entry = model_T_camera * Eigen::Map<const Eigen::Vector3d>(message.entry);
  seen.hole.axis = model_T_camera.linear() * Eigen::Map<const Eigen::Vector3d>(message.axis);
  if (!seen.hole.entry.allFinite() || seen.hole.entry.norm() > 10 ||
      !(std::abs(seen.hole.axis.norm() - 1) < 1e-6))
    return std::nullopt;
  seen.go = message.go;
  seen.reason = one_line(message.reason);
  seen.capture_time = capture_time;
  return seen;
}

}  // namespace

PoseInbox::PoseInbox(std::string model, std::string camera, const std::optional<SecretKey>& key)
    : model_(std::move(model)), camera_(std::move(camera)) {
  if (key) verifier_.emplace(*key);
}

void PoseInbox::take(const ReceivedMessage& message, int64_t now_ns, int64_t wall_minus_steady_ns) {
  const bool steady = is_clock_steady(now_ns, wall_minus_steady_ns);
  if (message.channel == channels::kPoses) {
    if (is_genuine(message)) take_poses(message);
  } else if (message.channel == channels::kDrillTargets) {
    if (!is_genuine(message)) return;
    if (!steady) return counters_.add("frames_after_the_clock_was_set");
    take_targets(message, wall_minus_steady_ns);
  }
}

/// When the wall clock is set, frames that are under way bear the old time: they would be placed where the
/// arm was at another moment. They are left out.
bool PoseInbox::is_clock_steady(int64_t now_ns, int64_t wall_minus_steady_ns) {
  if (wall_minus_steady_ns_ && std::abs(wall_minus_steady_ns - *wall_minus_steady_ns_) > kClockStep)
    clock_doubted_until_ns_ = now_ns + kUnderWay;
  wall_minus_steady_ns_ = wall_minus_steady_ns;
  return now_ns >= clock_doubted_until_ns_;
}

bool PoseInbox::is_genuine(const ReceivedMessage& message) {
  if (!verifier_) return true;
  switch (verifier_->judge(message.channel, message.data())) {
    case Authenticity::kGenuine:
      return true;
    case Authenticity::kUnsigned:
      counters_.add("messages_unsigned");
      return false;
    case Authenticity::kAltered:
      counters_.add("messages_altered");
      return false;
    case Authenticity::kReplayed:
      counters_.add("messages_replayed");
      return false;
  }
  return false;
}

void PoseInbox::take_poses(const ReceivedMessage& message) {
  edgepose_lcm::pose_estimates_t poses;
  if (!decode_checked(message.data(), poses).empty()) return counters_.add("messages_malformed");
  if (!camera_.empty() && poses.camera != camera_) return counters_.add("frames_of_other_cameras");
  if (poses_) counters_.add("answers_without_targets");
  poses_ = std::move(poses);
}

void PoseInbox::take_targets(const ReceivedMessage& message, int64_t wall_minus_steady_ns) {
  edgepose_lcm::drill_targets_t targets;
  if (!decode_checked(message.data(), targets).empty()) return counters_.add("messages_malformed");
  if (!camera_.empty() && targets.camera != camera_) return;
  if (!poses_ || poses_->sequence != targets.sequence || poses_->capture_utime != targets.capture_utime ||
      poses_->camera != targets.camera)
    return counters_.add("targets_without_answer");
  pair(targets, wall_minus_steady_ns);
  poses_.reset();
}

void PoseInbox::pair(const edgepose_lcm::drill_targets_t& targets, int64_t wall_minus_steady_ns) {
  counters_.add("frames");
  const auto answer = std::find_if(poses_->answers.begin(), poses_->answers.end(),
                                   [&](const auto& one) { return one.model == model_; });
  if (answer == poses_->answers.end()) return counters_.add("frames_without_the_model");
  if (answer->detections.empty()) return counters_.add("frames_without_a_pose");
  const edgepose_lcm::detection_t& best = answer->detections.front();
  const std::optional<RigidTransform> camera_T_model = from_message(best.camera_T_model);
  if (!camera_T_model) return counters_.add("poses_not_proper");

  PoseReading reading = reading_of(best, *camera_T_model);
  reading.sequence = poses_->sequence;
  // An absurd time must not overflow; the gate finds it stale or from the future.
  const int64_t utime = std::clamp<int64_t>(poses_->capture_utime, 0, int64_t{1} << 52);
  reading.capture_time = 1e-9 * static_cast<double>(utime * 1000 - wall_minus_steady_ns);

  std::map<std::string, SeenTarget> seen;
  const RigidTransform model_T_camera = camera_T_model->inverse();
  for (const edgepose_lcm::drill_target_t& target : targets.targets) {
    if (target.model != model_ || target.instance != 0 || seen.size() >= kMaxTargets) continue;
    if (target.content_hash != answer->content_hash) {
      counters_.add("targets_of_another_model");
      continue;
    }
    if (const auto one = seen_target(target, model_T_camera, reading.capture_time))
      seen[target.name] = *one;
    else
      counters_.add("targets_not_proper");
  }
  // Which of several bones is meant nobody knows.
  const auto accepted = std::count_if(answer->detections.begin(), answer->detections.end(),
                                      [](const auto& one) { return one.accepted; });
  if (accepted > 1) {
    counters_.add("frames_with_several_instances");
    reading.accepted = false;
    for (auto& [name, target] : seen) {
      target.go = false;
      target.reason = "the model is seen " + std::to_string(accepted) + " times";
    }
  }
  const std::scoped_lock lock(mutex_);
  targets_ = std::move(seen);
  if (!followed_.empty() && reading.accepted && !is_followed_target_sound()) {
    counters_.add("frames_without_go");
    reading.accepted = false;
  }
  reading_ = reading;
}

bool PoseInbox::is_followed_target_sound() const {
  const auto found = targets_.find(followed_);
  return found != targets_.end() && found->second.go && followed_hole_ &&
         is_same(found->second.hole, *followed_hole_);
}

std::optional<PoseReading> PoseInbox::take_reading() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return std::nullopt;
  return std::exchange(reading_, std::nullopt);
}

SeenTarget PoseInbox::find(const std::string& target, double now) const {
  const std::scoped_lock lock(mutex_);
  const std::string where = "target '" + target + "'";
  if (targets_.empty())
    throw InputError::at(where, "answers of the pose service that show model '" + model_ + "' and its plan",
                         "none yet", "edgepose watch shows what the service sees");
  const auto found = targets_.find(target);
  if (found == targets_.end()) {
    std::vector<std::string> known;
    for (const auto& [name, ignored] : targets_) known.push_back(name);
    throw InputError::at(where, "a hole of the plan of '" + model_ + "'", "none of that name",
                         "did you mean " + nearest_word(target, known) + "?");
  }
  const double age = now - found->second.capture_time;
  if (!(age <= kMaxTargetAge))
    throw InputError::at(where, "a frame of the last second that shows it",
                         "one taken " + std::to_string(age) + " s ago");
  if (!found->second.go) throw InputError::at(where, "the service's go", "no go: " + found->second.reason);
  return found->second;
}

void PoseInbox::follow(const std::string& target, const ServoGoal& hole) {
  const std::scoped_lock lock(mutex_);
  followed_ = target;
  followed_hole_ = hole;
}

}  // namespace edgepose
