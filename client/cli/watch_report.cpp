#include "client/cli/watch_report.h"

#include "client/cli/text.h"
#include "common/error.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

using namespace edgepose_lcm;

const char* mode_name(int8_t mode) {
  switch (mode) {
    case model_answer_t::DETECTION:
      return "detection";
    case model_answer_t::TRACKING:
      return "tracking";
    case model_answer_t::SKIPPED:
      return "skipped";
    default:
      return "unknown";
  }
}

std::string millimetres(const double (&v)[3]) {
  return formatted("%8.2f %8.2f %8.2f", rounded(1e3 * v[0], 2), rounded(1e3 * v[1], 2),
                   rounded(1e3 * v[2], 2));
}

std::string rotation(const rigid_transform_t& pose) {
  const auto transform = from_message(pose);
  if (!transform) return "                  -    ";
  const Eigen::AngleAxisd turn(transform->linear());
  const Eigen::Vector3d r = kDegrees * turn.angle() * turn.axis();
  return formatted("%7.2f %7.2f %7.2f", rounded(r.x(), 2), rounded(r.y(), 2), rounded(r.z(), 2));
}

}  // namespace

double latency(int64_t capture_utime, int64_t receive_utime) {
  return 1e-6 * (static_cast<double>(receive_utime) - static_cast<double>(capture_utime));
}

std::string heading_of_poses() {
  return formatted("%-20s %-9s %-5s %26s  %23s  %5s", "model", "mode", "found", "position in camera [mm]",
                   "rotation vector [deg]", "score");
}

std::vector<std::string> rows(const model_answer_t& answer) {
  const std::string name = one_line(answer.model);
  std::vector<std::string> list;
  for (const detection_t& detection : answer.detections)
    list.push_back(formatted("%-20.20s %-9s %-5s %s  %s  %5.2f", name.c_str(), mode_name(answer.mode),
                             detection.accepted ? "yes" : "no",
                             millimetres(detection.camera_T_model.translation).c_str(),
                             rotation(detection.camera_T_model).c_str(), detection.score));
  if (!answer.reason.empty() || answer.detections.empty())
    list.push_back(formatted("%-20.20s %-9s not found: ", name.c_str(), mode_name(answer.mode)) +
                   one_line(answer.reason));
  return list;
}

std::string heading_of_targets() {
  return formatted("%-22s %-16s %26s  %20s  %14s  %s", "target", "of model", "entry in camera [mm]", "axis",
                   "2 sigma mm deg", "go");
}

std::string row(const drill_target_t& target) {
  const double sigma = std::max(target.entry_sigma, target.tip_sigma);
  return formatted("%-22.22s %-16.16s %s  %6.3f %6.3f %6.3f  %7.3f %6.3f  %s", one_line(target.name).c_str(),
                   one_line(target.model).c_str(), millimetres(target.entry).c_str(), target.axis[0],
                   target.axis[1], target.axis[2], 2e3 * sigma, 2 * kDegrees * target.angle_sigma,
                   target.go ? "GO" : "NO-GO: ") +
         (target.go ? "" : one_line(target.reason));
}

std::string counts(const std::vector<counter_t>& counters) {
  std::string text;
  for (const counter_t& counter : counters)
    if (counter.value != 0)
      text += (text.empty() ? "" : ", ") + one_line(counter.name) + " " + std::to_string(counter.value);
  return text;
}

std::string line(const pose_estimates_t& answer, int64_t receive_utime) {
  std::string text =
      formatted("%s %lld, %.0f ms:", one_line(answer.camera).c_str(), static_cast<long long>(answer.sequence),
                1e3 * latency(answer.capture_utime, receive_utime));
  if (answer.answers.empty()) text += " no active model";
  for (size_t i = 0; i < answer.answers.size(); ++i) {
    const model_answer_t& model = answer.answers[i];
    text += (i == 0 ? " " : "; ") + one_line(model.model);
    bool any = false;
    for (const detection_t& detection : model.detections) {
      if (!detection.accepted) continue;
      any = true;
      const double* t = detection.camera_T_model.translation;
      text += formatted(" at (%.2f, %.2f, %.2f) mm score %.2f", rounded(1e3 * t[0], 2),
                        rounded(1e3 * t[1], 2), rounded(1e3 * t[2], 2), detection.score);
    }
    text += any ? std::string(" by ") + mode_name(model.mode) : " not found: " + one_line(model.reason);
  }
  const std::string dropped = counts(answer.dropped);
  return dropped.empty() ? text : text + "; dropped before: " + dropped;
}

std::string line(const drill_targets_t& message) {
  std::string text = formatted("%s %lld, drill targets:", one_line(message.camera).c_str(),
                               static_cast<long long>(message.sequence));
  if (message.targets.empty()) text += " none";
  for (size_t i = 0; i < message.targets.size(); ++i) {
    const drill_target_t& target = message.targets[i];
    text += (i == 0 ? " " : "; ") + one_line(target.name) +
            (target.go ? " GO" : " NO-GO (" + one_line(target.reason) + ")");
  }
  return text;
}

}  // namespace edgepose
