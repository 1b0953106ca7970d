#include "client/service/answer_judge.h"

#include <algorithm>
#include <cmath>

#include "messaging/transform_message.h"

namespace edgepose {
namespace {

using namespace edgepose_lcm;

constexpr double kMaxAhead = 1;  // [s] that clocks may differ

bool is_sound(const detection_t& detection) {
  return from_message(detection.camera_T_model).has_value() && std::isfinite(detection.score) &&
         std::all_of(detection.camera_T_equivalent.begin(), detection.camera_T_equivalent.end(),
                     [](const auto& pose) { return from_message(pose).has_value(); });
}

bool is_sound(const pose_estimates_t& message) {
  return std::all_of(message.answers.begin(), message.answers.end(), [](const model_answer_t& answer) {
    return std::all_of(answer.detections.begin(), answer.detections.end(),
                       [](const detection_t& detection) { return is_sound(detection); });
  });
}

bool is_sound(const drill_targets_t& message) {
  const auto finite = [](const double(&v)[3]) { return std::isfinite(v[0] + v[1] + v[2]); };
  return std::all_of(message.targets.begin(), message.targets.end(), [&](const drill_target_t& target) {
    return finite(target.entry) && finite(target.axis) &&
           std::isfinite(target.depth + target.diameter + target.entry_sigma + target.tip_sigma +
                         target.angle_sigma);
  });
}

const char* cause(Authenticity authenticity) {
  switch (authenticity) {
    case Authenticity::kUnsigned:
      return "unsigned";
    case Authenticity::kAltered:
      return "altered";
    case Authenticity::kReplayed:
      return "replayed";
    case Authenticity::kGenuine:
      break;
  }
  return nullptr;
}

}  // namespace

AnswerJudge::AnswerJudge(const std::optional<SecretKey>& key, double max_age) : max_age_(max_age) {
  if (key) verifier_.emplace(*key);
}

bool AnswerJudge::refuse(const std::string& cause) {
  ++refused_[cause];
  return false;
}

template <class Message>
bool AnswerJudge::take_signed(const ReceivedMessage& message, int64_t now_utime, Message& decoded) {
  if (verifier_)
    if (const char* fault = cause(verifier_->judge(message.channel, message.data())); fault != nullptr)
      return refuse(fault);
  if (!decode_checked(message.data(), decoded).empty() || !is_sound(decoded)) return refuse("malformed");
  const double age = 1e-6 * (static_cast<double>(now_utime) - static_cast<double>(decoded.send_utime));
  const double taken = 1e-6 * (static_cast<double>(now_utime) - static_cast<double>(decoded.capture_utime));
  if (verifier_ && (age > max_age_ || taken > max_age_)) return refuse("old");
  if (verifier_ && age < -kMaxAhead) return refuse("from_the_future");
  return true;
}

bool AnswerJudge::take(const ReceivedMessage& message, int64_t now_utime, pose_estimates_t& answer) {
  return take_signed(message, now_utime, answer);
}

bool AnswerJudge::take(const ReceivedMessage& message, int64_t now_utime, drill_targets_t& targets) {
  return take_signed(message, now_utime, targets);
}

bool AnswerJudge::take(const ReceivedMessage& message, service_status_t& status) {
  return decode_checked(message.data(), status).empty() || refuse("malformed");
}

}  // namespace edgepose
