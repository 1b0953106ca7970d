#include "client/service/frame_restamp.h"

#include "messaging/channels.h"
#include "messaging/checked_decode.h"
#include "messaging/lcm_publisher.h"

namespace edgepose {
namespace {

template <class Message>
bool identity_as(const std::vector<std::byte>& bytes, std::string& camera, int64_t& sequence) {
  Message message;
  if (!decode_checked(std::span<const std::byte>(bytes), message).empty()) return false;
  camera = message.camera;
  sequence = message.sequence;
  return true;
}

}  // namespace

template <class Message>
FrameRestamp::Outcome FrameRestamp::restamp_as(int64_t now_utime, std::vector<std::byte>& bytes) {
  Message message;
  if (!decode_checked(std::span<const std::byte>(bytes), message).empty()) return Outcome::kMalformed;
  const int64_t origin = logged_first_.try_emplace(message.camera, message.sequence).first->second;
  int64_t moved = 0;
  if (__builtin_sub_overflow(message.sequence, origin, &moved) ||
      __builtin_add_overflow(moved, first_, &moved))
    return Outcome::kBeyond;
  message.sequence = moved;
  message.capture_utime = now_utime;
  bytes = encode(message);
  return Outcome::kDone;
}

FrameRestamp::Outcome FrameRestamp::restamp(const std::string& channel, int64_t now_utime,
                                            std::vector<std::byte>& message) {
  if (channel == channels::kDepth) return restamp_as<edgepose_lcm::depth_frame_t>(now_utime, message);
  if (channel == channels::kCloud) return restamp_as<edgepose_lcm::cloud_frame_t>(now_utime, message);
  return Outcome::kMalformed;
}

bool frame_identity(const std::string& channel, const std::vector<std::byte>& message, std::string& camera,
                    int64_t& sequence) {
  if (channel == channels::kDepth) return identity_as<edgepose_lcm::depth_frame_t>(message, camera, sequence);
  if (channel == channels::kCloud) return identity_as<edgepose_lcm::cloud_frame_t>(message, camera, sequence);
  return false;
}

}  // namespace edgepose
