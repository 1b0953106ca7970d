#include "server/frame_intake.h"

#include <new>

#include "daemon/clock.h"
#include "daemon/log.h"
#include "messaging/channels.h"
#include "messaging/checked_decode.h"
#include "server/answer_messages.h"

namespace edgepose {

void FrameIntake::take(const ReceivedMessage& message) {
  if (message.channel == kDepthChannel) {
    try {
      take_depth(message);
    } catch (const std::bad_alloc&) {
      refuse("", "out_of_memory", "memory: expected enough for the frame, found less");
    }
  } else if (message.channel != channels::kPoses && message.channel != channels::kDrillTargets &&
             message.channel != channels::kStatus &&
             message.channel != channels::kArmState) {  // what the daemon itself says comes back to it
    counters_.add("messages_of_other_channels");
  }
}

void FrameIntake::take_depth(const ReceivedMessage& message) {
  const int64_t now = utime_now();
  counters_.add("frames_received");
  edgepose_lcm::depth_frame_t encoded;
  if (const std::string fault = decode_checked(message.data(), encoded); !fault.empty())
    return refuse("", "malformed", fault);
  const FrameOptions options = options_();
  const double pixels = static_cast<double>(encoded.width) * encoded.height;
  if (pixels > options.max_pixels)
    return refuse(judge_.skip(encoded.camera, encoded.sequence) ? encoded.camera : "", "too_many_pixels",
                  "width x height: expected at most " + std::to_string(options.max_pixels) +
                      " pixels (frames.max_pixels), found " + std::to_string(encoded.width) + " x " +
                      std::to_string(encoded.height));
  DepthFrame frame;
  std::string detail;
  if (const FrameFault fault = unpack(encoded, frame, detail); fault != FrameFault::kNone) {
    // A camera's name is believed only where the judge has seen it, so that lies fill no table.
    const bool is_known = judge_.skip(encoded.camera, encoded.sequence);
    return refuse(is_known ? encoded.camera : "", name(fault), detail);
  }
  const FrameVerdict verdict = judge_.judge(frame.camera, frame.sequence, frame.capture_utime, now, options);
  if (!verdict.refusal.empty())
    return refuse(verdict.refusal == "too_many_cameras" ? "" : frame.camera, verdict.refusal, verdict.detail);
  if (verdict.lost > 0) {
    counters_.add("frames_lost", static_cast<uint64_t>(verdict.lost));
    mailbox_.note_dropped(frame.camera, "lost", verdict.lost);
  }
  if (verdict.restarted) {
    counters_.add("cameras_restarted");
    log_limited(LogLevel::kInfo, "camera_restarted", frame.camera,
                {{"sequence", std::to_string(frame.sequence)}});
  }
  if (mailbox_.put(std::move(frame), now)) counters_.add("frames_superseded");
}

void FrameIntake::refuse(const std::string& camera, const std::string& cause, const std::string& detail) {
  counters_.add("frames_refused_" + cause);
  if (!camera.empty()) mailbox_.note_dropped(camera, cause, 1);
  log_limited(LogLevel::kWarning, "frame_refused", cause, {{"camera", camera}, {"detail", detail}});
}

}  // namespace edgepose
