#pragma once
#include <atomic>

#include "client/service/clock.h"
#include "messaging/channels.h"
#include "messaging/checked_decode.h"
#include "messaging/transform_message.h"
#include "tests/client/bus.h"

namespace edgepose::test {

/// An answer with one accepted pose of model "part" at (x, 0, 0.5) m.
inline edgepose_lcm::pose_estimates_t answer_with(const std::string& camera, int64_t sequence, double x) {
  edgepose_lcm::detection_t detection{};
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Eigen::Vector3d(x, 0, 0.5);
  detection.camera_T_model = to_message(pose);
  detection.accepted = true;
  detection.score = 0.9;
  edgepose_lcm::model_answer_t model{};
  model.model = "part";
  model.mode = edgepose_lcm::model_answer_t::TRACKING;
  model.detections = {detection};
  model.detections_count = 1;
  edgepose_lcm::pose_estimates_t answer{};
  answer.camera = camera;
  answer.sequence = sequence;
  answer.capture_utime = answer.send_utime = utime_now();
  answer.answers = {model};
  answer.answers_count = 1;
  return answer;
}

/// Answers each depth frame as the daemon would: always the same for the same image.
class FakeService {
 public:
  Bus& bus() { return bus_; }
  std::atomic<double> offset{0};  ///< [m] added to every pose
  std::atomic<bool> silent{false};

 private:
  void answer(const ReceivedMessage& message) {
    edgepose_lcm::depth_frame_t frame;
    if (silent || message.channel != channels::kDepth || !decode_checked(message.data(), frame).empty())
      return;
    const double x = 1e-10 * static_cast<double>(frame.checksum) + offset;
    publisher_.publish(channels::kPoses, encode(answer_with(frame.camera, frame.sequence, x)));
  }
  LcmPublisher publisher_{parse_udpm_url(kDefaultLcmUrl)};
  Bus bus_{[this](const ReceivedMessage& message) { answer(message); }};
};

}  // namespace edgepose::test
