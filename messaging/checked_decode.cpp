#include "messaging/checked_decode.h"

#include "messaging/message_walk.h"
#include "messaging/udpm_packet.h"

namespace edgepose {
namespace {

using namespace edgepose_lcm;

// Most that a message may hold: beyond any use, so that what is refused is an attack or a fault.
constexpr int32_t kMaxName = 255, kMaxReason = 1023;
constexpr int32_t kMaxDepthBytes = 32 << 20, kMaxCloudValues = 6'000'000;
constexpr int32_t kMaxAnswers = 256, kMaxDetections = 256, kMaxEquivalents = 1024;
constexpr int32_t kMaxTargets = 4096, kMaxCounters = 256;
constexpr size_t kI64 = 8, kI32 = 4, kDouble = 8, kFlag = 1, kText = 5;  // kText: an empty string
constexpr size_t kTransform = 7 * kDouble, kAuthentication = 2 * kI64 + 32;
constexpr size_t kDetectionHead = kTransform + 36 * kDouble + kDouble + kFlag + 4 * kDouble;

void walk_counters(MessageWalk& walk, const char* field) {
  for (int32_t n = walk.count(field, kMaxCounters, kText + kI64); n > 0; --n)
    walk.text("counter_t.name", kMaxName).skip(kI64);
}

void walk_answer(MessageWalk& walk) {
  walk.text("model", kMaxName).skip(kI64 + 1).text("reason", kMaxReason).skip(5 * kDouble);
  for (int32_t n = walk.count("detections_count", kMaxDetections, kDetectionHead + kI32); n > 0; --n)
    walk.skip(kDetectionHead).array("equivalents", kMaxEquivalents, kTransform);
}

void walk_target(MessageWalk& walk) {
  walk.text("model", kMaxName).skip(kI64 + kI32).text("name", kMaxName);
  walk.skip((3 + 3 + 2 + 3 + 2) * kDouble + kFlag).text("reason", kMaxReason);
}

}  // namespace

std::string check_lengths(std::span<const std::byte> bytes, const depth_frame_t*) {
  MessageWalk walk(bytes);
  walk.fingerprint(depth_frame_t::getHash()).skip(2 * kI64).text("camera", kMaxChannelLength);
  walk.skip(2 * kI32 + 5 * kDouble + 1 + kI64).array("size", kMaxDepthBytes, 1).end();
  return walk.fault();
}

std::string check_lengths(std::span<const std::byte> bytes, const cloud_frame_t*) {
  MessageWalk walk(bytes);
  walk.fingerprint(cloud_frame_t::getHash()).skip(2 * kI64).text("camera", kMaxChannelLength);
  walk.skip(kI64).array("values", kMaxCloudValues, sizeof(float)).end();
  return walk.fault();
}

std::string check_lengths(std::span<const std::byte> bytes, const pose_estimates_t*) {
  MessageWalk walk(bytes);
  walk.fingerprint(pose_estimates_t::getHash()).skip(2 * kI64).text("camera", kMaxChannelLength);
  walk.skip(2 * kI64 + kDouble + kFlag);
  walk_counters(walk, "dropped_count");
  constexpr size_t kLeastAnswer = 2 * kText + kI64 + 1 + 5 * kDouble + kI32;
  for (int32_t n = walk.count("answers_count", kMaxAnswers, kLeastAnswer); n > 0; --n) walk_answer(walk);
  walk.skip(kAuthentication).end();
  return walk.fault();
}

std::string check_lengths(std::span<const std::byte> bytes, const drill_targets_t*) {
  MessageWalk walk(bytes);
  walk.fingerprint(drill_targets_t::getHash()).skip(2 * kI64).text("camera", kMaxChannelLength).skip(kI64);
  constexpr size_t kLeastTarget = 3 * kText + kI64 + kI32 + 13 * kDouble + kFlag;
  for (int32_t n = walk.count("targets_count", kMaxTargets, kLeastTarget); n > 0; --n) walk_target(walk);
  walk.skip(kAuthentication).end();
  return walk.fault();
}

std::string check_lengths(std::span<const std::byte> bytes, const service_status_t*) {
  MessageWalk walk(bytes);
  walk.fingerprint(service_status_t::getHash()).skip(kI64 + kDouble).text("version", kMaxName);
  walk.skip(2 * kDouble);
  for (int32_t n = walk.count("models_count", kMaxAnswers, kText); n > 0; --n) walk.text("models", kMaxName);
  walk_counters(walk, "counters_count");
  walk.end();
  return walk.fault();
}

}  // namespace edgepose
