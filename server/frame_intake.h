#pragma once
#include <functional>

#include "daemon/counters.h"
#include "messaging/udpm_assembly.h"
#include "server/frame_judge.h"
#include "server/frame_mailbox.h"

namespace edgepose {

/// The channel that depth frames come on.
inline constexpr const char* kDepthChannel = "EDGEPOSE_DEPTH";

/// What every received message goes through, on the receiver's thread: channel, lengths, meaning, times. A
/// sound depth frame ends in the mailbox; everything else is counted by cause ("frames_refused_CAUSE") and
/// logged. Never throws.
class FrameIntake {
 public:
  /// `options`: what holds at the time of the call. All arguments must outlive the intake.
  FrameIntake(FrameMailbox& mailbox, Counters& counters, std::function<FrameOptions()> options)
      : mailbox_(mailbox), counters_(counters), options_(std::move(options)) {}

  void take(const ReceivedMessage& message);

 private:
  void take_depth(const ReceivedMessage& message);
  void refuse(const std::string& camera, const std::string& cause, const std::string& detail);

  FrameMailbox& mailbox_;
  Counters& counters_;
  const std::function<FrameOptions()> options_;
  FrameJudge judge_;
};

}  // namespace edgepose
