#include "simulator/pose_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "arm/rigid_motion.h"
#include "common/error.h"
#include "matcher/option_range.h"
#include "messaging/lcm_publisher.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

constexpr const char* kPoses = "EDGEPOSE_POSES";
constexpr const char* kTargets = "EDGEPOSE_DRILL_TARGETS";
constexpr size_t kKept = 10;            // answers
constexpr int64_t kSecond = 1'000'000;  // [us]
constexpr double kLeastSigma = 1e-4;    // [m], [rad] that a service claims at least
constexpr double kAngleSigma = 1e-3;    // [rad]
constexpr std::array<std::string_view, static_cast<size_t>(PoseWrong::kCount)> kWrongs{
    "none",     "old",      "duplicate", "future",          "jump_50mm",
    "turn_20",  "turn_180", "nan",       "not_orthonormal", "zero_quaternion",
    "unsigned", "altered",  "replayed",  "silent",          "hour_step"};

RigidTransform turned(double degrees) {
  return rigid_transform(rotation_matrix({degrees * std::numbers::pi / 180, 0, 0}), Eigen::Vector3d::Zero());
}

RigidTransform moved(const RigidTransform& pose, PoseWrong wrong) {
  if (wrong == PoseWrong::kJump50mm) return Eigen::Translation3d(0.05, 0, 0) * pose;
  if (wrong == PoseWrong::kTurn20) return pose * turned(20);
  if (wrong == PoseWrong::kTurn180) return pose * turned(180);
  return pose;
}

void spoil(edgepose_lcm::rigid_transform_t& pose, PoseWrong wrong) {
  if (wrong == PoseWrong::kNan) pose.translation[1] = std::numeric_limits<double>::quiet_NaN();
  const double norm = wrong == PoseWrong::kNotOrthonormal ? 1.1 : wrong == PoseWrong::kZeroQuaternion ? 0 : 1;
  for (double& value : pose.quaternion) value *= norm;
}

edgepose_lcm::drill_target_t target_message(const DrillTarget& target, const std::string& model,
                                            const RigidTransform& camera_T_model,
                                            const PoseSourceOptions& options) {
  edgepose_lcm::drill_target_t m{};
  const Eigen::Vector3d entry = camera_T_model * target.entry, axis = camera_T_model.linear() * target.axis;
  m.model = model;
  m.content_hash = options.content_hash;
  m.name = target.name;
  for (int i = 0; i < 3; ++i) m.entry[i] = entry[i], m.axis[i] = axis[i];
  m.depth = target.depth;
  m.diameter = target.diameter;
  m.entry_sigma = m.tip_sigma = std::max(kLeastSigma, options.sigma);
  m.angle_sigma = std::max(kAngleSigma, options.angle_sigma);
  m.position_tolerance = target.position_tolerance;
  m.angle_tolerance = target.angle_tolerance;
  m.go = true;
  return m;
}

}  // namespace

std::optional<PoseWrong> pose_wrong_named(const std::string& name) {
  const auto found = std::find(kWrongs.begin(), kWrongs.end(), name);
  if (found == kWrongs.end()) return std::nullopt;
  return static_cast<PoseWrong>(found - kWrongs.begin());
}

std::string name_of(PoseWrong wrong) { return std::string(kWrongs.at(static_cast<size_t>(wrong))); }

std::string pose_wrong_names() {
  std::string names;
  for (const std::string_view name : kWrongs) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

std::string PoseSourceOptions::check() const {
  if (camera.empty() || camera.size() > 63)
    return "camera: expected a name of 1 to 63 bytes, found " + std::to_string(camera.size());
  return option_fault({{"sigma", sigma, 0, 0.1}, {"angle_sigma", angle_sigma, 0, 1}, {"score", score, 0, 1}});
}

PoseSource::PoseSource(const DrillPlan& plan, const std::optional<SecretKey>& key,
                       const PoseSourceOptions& options)
    : plan_(plan), options_(options), draws_(options.seed, DrawPurpose::kPose) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("poses: " + fault);
  if (key) signer_.emplace(*key, options.session);
}

void PoseSource::set_wrong(PoseWrong wrong, int count) {
  hour_later_ = hour_later_ || wrong == PoseWrong::kHourStep;
  wrong_ = wrong == PoseWrong::kHourStep ? PoseWrong::kNone : wrong;
  wrong_left_ = count;
}

PoseSource::Answer PoseSource::answer(const RigidTransform& truth, int64_t capture_utime, int64_t now_utime) {
  const int64_t later = hour_later_ ? 3600 * kSecond : 0;
  if (wrong_ == PoseWrong::kOld) capture_utime -= 2 * kSecond;
  if (wrong_ == PoseWrong::kFuture) capture_utime = now_utime + kSecond;
  const Eigen::Vector3d turn = draws_.gauss(options_.angle_sigma), shift = draws_.gauss(options_.sigma);
  const RigidTransform measured =
      rigid_transform(rotation_matrix(turn) * truth.linear(), truth.translation() + shift);
  const RigidTransform pose = moved(measured, wrong_);

  edgepose_lcm::detection_t detection{};
  detection.camera_T_model = to_message(pose);
  spoil(detection.camera_T_model, wrong_);
  for (int i = 0; i < 6; ++i) {
    const double sigma =
        i < 3 ? std::max(kAngleSigma, options_.angle_sigma) : std::max(kLeastSigma, options_.sigma);
    detection.covariance[i][i] = sigma * sigma;
  }
  detection.score = detection.coverage = options_.score;
  detection.edge_score = -1;
  detection.accepted = true;
  detection.margin = 0.5;
  edgepose_lcm::model_answer_t model{};
  model.model = plan_.model;
  model.content_hash = options_.content_hash;
  model.mode = edgepose_lcm::model_answer_t::TRACKING;
  model.detections_count = 1;
  model.detections = {detection};

  Answer made{};
  edgepose_lcm::pose_estimates_t& poses = made.poses;
  edgepose_lcm::drill_targets_t& targets = made.targets;
  poses.sequence = targets.sequence = ++sequence_;
  poses.capture_utime = targets.capture_utime = capture_utime + later;
  poses.camera = targets.camera = options_.camera;
  poses.receive_utime = poses.send_utime = targets.send_utime = now_utime + later;
  poses.answers_count = 1;
  poses.answers = {model};
  for (const DrillTarget& target : plan_.targets)
    targets.targets.push_back(target_message(target, plan_.model, pose, options_));
  if (wrong_ == PoseWrong::kNan)
    for (auto& target : targets.targets) target.entry[1] = std::numeric_limits<double>::quiet_NaN();
  targets.targets_count = static_cast<int32_t>(targets.targets.size());
  return made;
}

std::vector<OutgoingMessage> PoseSource::signed_messages(const Answer& answer) {
  std::vector<OutgoingMessage> sent = {{kPoses, encode(answer.poses)}, {kTargets, encode(answer.targets)}};
  if (signer_ && wrong_ != PoseWrong::kUnsigned)
    for (OutgoingMessage& message : sent) signer_->sign(message.channel, message.bytes);
  return sent;
}

/// The content that differs by one bit of a coordinate, under the signature of the other.
void PoseSource::alter(const Answer& answer, std::vector<OutgoingMessage>& sent) {
  const auto flipped = [](double value) {
    return std::bit_cast<double>(std::bit_cast<uint64_t>(value) ^ uint64_t{1} << 48);
  };
  Answer other = answer;
  double& x = other.poses.answers[0].detections[0].camera_T_model.translation[0];
  x = flipped(x);
  for (auto& target : other.targets.targets) target.entry[0] = flipped(target.entry[0]);
  const std::array<std::vector<std::byte>, 2> contents = {encode(other.poses), encode(other.targets)};
  for (size_t i = 0; i < contents.size(); ++i)
    std::copy(contents[i].begin(), contents[i].end() - static_cast<std::ptrdiff_t>(kAuthenticationBytes),
              sent[i].bytes.begin());
}

std::vector<OutgoingMessage> PoseSource::messages(const RigidTransform& camera_T_model, int64_t capture_utime,
                                                  int64_t now_utime) {
  const Answer made = answer(camera_T_model, capture_utime, now_utime);
  std::vector<OutgoingMessage> sent;
  switch (wrong_) {
    case PoseWrong::kSilent:
      break;
    case PoseWrong::kDuplicate:
      if (last_) sent = signed_messages(*last_);
      break;
    case PoseWrong::kReplayed:
      if (!genuine_.empty()) sent = genuine_.front();
      break;
    default:
      sent = signed_messages(made);
      if (wrong_ == PoseWrong::kAltered) alter(made, sent);
  }
  if (wrong_ == PoseWrong::kNone) {
    last_ = made;
    genuine_.push_back(sent);
    if (genuine_.size() > kKept) genuine_.pop_front();
  }
  if (wrong_ != PoseWrong::kNone && wrong_left_ > 0 && --wrong_left_ == 0) wrong_ = PoseWrong::kNone;
  return sent;
}

}  // namespace edgepose
