#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "messaging/depth_message.h"

namespace edgepose {

/// A frame on its way to the matcher, and what came between it and the one before.
struct WaitingFrame {
  DepthFrame depth;
  int64_t receive_utime = 0;               ///< [us] since 1970: when it had arrived whole
  std::map<std::string, int64_t> dropped;  ///< frames of this camera not looked at since the last, by cause
};

/// One place for each camera: the newest frame wins, and there is never a queue. Safe from any thread.
class FrameMailbox {
 public:
  /// True if a frame that waited has been replaced.
  bool put(DepthFrame&& frame, int64_t receive_utime);
  /// Frames of `camera` that never come here.
  void note_dropped(const std::string& camera, const std::string& cause, int64_t count);
  /// Waits for a frame or for wake(); cameras take turns, the one that waits longest first. Nothing if woken
  /// while no frame waits.
  std::optional<WaitingFrame> take();
  /// Makes take() return, with a frame or without, this time or, if nobody waits, the next.
  void wake();
  /// Cameras that are remembered.
  size_t cameras() const;

 private:
  struct Slot {
    std::optional<DepthFrame> frame;
    int64_t receive_utime = 0;
    uint64_t since = 0;  ///< order of arrival of the first frame that waits
    std::map<std::string, int64_t> dropped;
  };
  Slot* longest_waiting();
  Slot& slot(const std::string& camera);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Slot> slots_;
  uint64_t arrivals_ = 0;
  bool woken_ = false;
};

}  // namespace edgepose
