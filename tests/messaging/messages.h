#pragma once
#include <random>
#include <string>
#include <vector>

#include "messaging/checked_decode.h"

/// Messages with every part that they can have, from a seed.
namespace edgepose::messages {

template <class Message>
std::vector<std::byte> encoded(const Message& message) {
  std::vector<std::byte> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

inline edgepose_lcm::depth_frame_t depth_frame(std::mt19937_64& random) {
  edgepose_lcm::depth_frame_t m{};
  m.camera = std::string(1 + random() % 63, 'c');
  m.data.resize(random() % 300, 7);
  m.size = static_cast<int32_t>(m.data.size());
  return m;
}

inline edgepose_lcm::cloud_frame_t cloud_frame(std::mt19937_64& random) {
  edgepose_lcm::cloud_frame_t m{};
  m.camera = "camera";
  m.xyz.resize(3 * (random() % 50));
  m.values = static_cast<int32_t>(m.xyz.size());
  for (auto& x : m.xyz) x = static_cast<float>(random() % 100);
  return m;
}

inline edgepose_lcm::pose_estimates_t pose_estimates(std::mt19937_64& random) {
  edgepose_lcm::pose_estimates_t m{};
  m.camera = "camera";
  m.dropped.resize(random() % 4);
  m.dropped_count = static_cast<int32_t>(m.dropped.size());
  for (auto& counter : m.dropped) counter.name = "superseded";
  m.answers.resize(random() % 4);
  m.answers_count = static_cast<int32_t>(m.answers.size());
  for (auto& answer : m.answers) {
    answer.model = "vertebra";
    answer.reason = std::string(random() % 20, 'r');
    answer.detections.resize(random() % 3);
    answer.detections_count = static_cast<int32_t>(answer.detections.size());
    for (auto& detection : answer.detections) {
      detection.camera_T_equivalent.resize(random() % 3);
      detection.equivalents = static_cast<int32_t>(detection.camera_T_equivalent.size());
    }
  }
  return m;
}

inline edgepose_lcm::drill_targets_t drill_targets(std::mt19937_64& random) {
  edgepose_lcm::drill_targets_t m{};
  m.camera = "camera";
  m.targets.resize(random() % 5);
  m.targets_count = static_cast<int32_t>(m.targets.size());
  for (auto& target : m.targets) target.model = "vertebra", target.name = "left", target.reason = "";
  return m;
}

inline edgepose_lcm::service_status_t service_status(std::mt19937_64& random) {
  edgepose_lcm::service_status_t m{};
  m.version = "0.1.0";
  m.models.resize(random() % 4, "vertebra");
  m.models_count = static_cast<int32_t>(m.models.size());
  m.counters.resize(random() % 4);
  m.counters_count = static_cast<int32_t>(m.counters.size());
  for (auto& counter : m.counters) counter.name = "frames";
  return m;
}

}  // namespace edgepose::messages
