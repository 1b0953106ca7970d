#pragma once
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/counters.h"
#include "messaging/depth_message.h"
#include "server/recent.h"

namespace edgepose {

/// Which frame was answered last.
struct LastFrame {
  std::string camera;
  int64_t sequence = 0, capture_utime = 0;
};

/// What the daemon can tell of its work. Safe from any thread.
struct Statistics {
  Counters counters;
  Recent latency;       ///< capture to publication
  Recent service_time;  ///< receipt to publication
  Recent detecting, tracking, preprocessing, waiting;

  std::map<std::string, const Recent*> stages() const {
    return {{"latency", &latency},   {"service", &service_time},        {"detection", &detecting},
            {"tracking", &tracking}, {"preprocessing", &preprocessing}, {"waiting", &waiting}};
  }
  void note_frame(const LastFrame& frame) {
    const std::scoped_lock lock(mutex_);
    last_ = frame;
  }
  std::optional<LastFrame> last_frame() const {
    const std::scoped_lock lock(mutex_);
    return last_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<LastFrame> last_;
};

}  // namespace edgepose
