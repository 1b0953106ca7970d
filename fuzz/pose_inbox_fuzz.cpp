#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "controller/pose_inbox.h"
#include "fuzz/input_check.h"
#include "messaging/big_endian.h"
#include "messaging/channels.h"
#include "servoing/proper_pose.h"

namespace {

edgepose::ReceivedMessage message_of(const char* channel, const uint8_t* data, size_t size, int64_t hash) {
  edgepose::ReceivedMessage message{channel, std::make_unique<std::byte[]>(size), size};
  std::copy_n(reinterpret_cast<const std::byte*>(data), size, message.bytes.get());
  if (size >= 8) edgepose::write_big_endian<int64_t>(hash, {message.bytes.get(), size}, 0);
  return message;
}

}  // namespace

// An answer and its drill targets, up to the gate: what the arm may follow is a pose, and a hole a hole.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  if (size < 2) return 0;
  const size_t first = std::min<size_t>(data[0] << 8 | data[1], size - 2);
  PoseInbox inbox("vertebra_phantom", "", std::nullopt);
  constexpr int64_t kWall = 1'700'000'000'000'000'000;
  inbox.take(message_of(channels::kPoses, data + 2, first, edgepose_lcm::pose_estimates_t::getHash()), 0,
             kWall);
  inbox.take(message_of(channels::kDrillTargets, data + 2 + first, size - 2 - first,
                        edgepose_lcm::drill_targets_t::getHash()),
             0, kWall);
  const auto reading = inbox.take_reading();
  if (!reading) return 0;
  must_hold(std::isfinite(reading->capture_time));
  PoseGate gate({});
  const double now = reading->capture_time + 0.1;
  if (gate.judge(*reading, now, true, std::nullopt) == PoseVerdict::kTaken)
    must_hold(is_proper(reading->camera_T_model) && reading->covariance.allFinite());
  try {
    const SeenTarget target = inbox.find("left_pedicle_screw", now);
    must_hold(target.hole.entry.allFinite() && std::abs(target.hole.axis.norm() - 1) < 1e-6);
  } catch (const InputError&) {
  }
  return 0;
}
