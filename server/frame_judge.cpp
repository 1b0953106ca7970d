#include "server/frame_judge.h"

#include <algorithm>

namespace edgepose {
namespace {

constexpr int64_t kSilence = 10'000'000;  // [us] after which a camera may be forgotten
/// A camera that was restarted, or whose clock was set back, goes on from where it is then: so many frames
/// that follow each other are believed. Old frames sent again one by one are not.
constexpr int kStraysBelieved = 3;
constexpr double kFastest = 500;  // [frames/s]

std::string milliseconds(int64_t us) { return std::to_string(us / 1000) + " ms"; }

bool follows(int64_t sequence, int64_t capture_utime, int64_t last_sequence, int64_t last_utime) {
  return sequence > last_sequence && capture_utime > last_utime;
}

}  // namespace

FrameVerdict FrameJudge::judge(const std::string& camera, int64_t sequence, int64_t capture_utime,
                               int64_t receive_utime, const FrameOptions& options) {
  // In double: the difference of any two 64-bit numbers fits.
  // What is refused for its time is not missing before the next frame.
  const double age = 1e-6 * (static_cast<double>(receive_utime) - static_cast<double>(capture_utime));
  if (age < -options.max_ahead || age > options.max_age) skip(camera, sequence);
  if (age < -options.max_ahead)
    return {"from_the_future", "capture_utime: expected not after the clock here, found " +
                                   std::to_string(-age) + " s later; are the clocks in step?"};
  if (age > options.max_age)
    return {"too_old", "capture_utime: expected at most " + std::to_string(options.max_age) +
                           " s ago (frames.max_age), found " + std::to_string(age) + " s"};
  auto known = cameras_.find(camera);
  if (known == cameras_.end()) {
    if (!make_room(receive_utime, options))
      return {"too_many_cameras", "camera: expected one of the " + std::to_string(cameras_.size()) +
                                      " that are sending (frames.max_cameras), found another"};
    cameras_[camera] = {{sequence, capture_utime}, 0, {}, 0, receive_utime};
    return {};
  }
  Track& track = known->second;
  track.heard = receive_utime;
  if (follows(sequence, capture_utime, track.last.sequence, track.last.capture_utime)) {
    const double seconds = 1e-6 * static_cast<double>(capture_utime - track.last.capture_utime);
    const double missing = static_cast<double>(sequence) - static_cast<double>(track.last.sequence) - 1 -
                           static_cast<double>(track.skipped);
    track.last = {sequence, capture_utime};
    track.skipped = 0;
    track.strays = 0;
    // No camera is so fast: it has been started anew with higher numbers.
    if (missing > kFastest * seconds + kStraysBelieved) return {"", "", 0, true};
    return {"", "", static_cast<int64_t>(std::max(missing, 0.0))};
  }
  const bool goes_on = track.strays > 0 &&
                       follows(sequence, capture_utime, track.strayed.sequence, track.strayed.capture_utime);
  track.strays = goes_on ? track.strays + 1 : 1;
  track.strayed = {sequence, capture_utime};
  if (track.strays >= kStraysBelieved) {
    track.last = track.strayed;
    track.skipped = 0;
    track.strays = 0;
    return {"", "", 0, true};
  }
  if (sequence <= track.last.sequence)
    return {"sequence_went_back", "sequence: expected more than " + std::to_string(track.last.sequence) +
                                      ", found " + std::to_string(sequence)};
  ++track.skipped;
  return {"time_went_back", "capture_utime: expected later than the frame before, found " +
                                milliseconds(track.last.capture_utime - capture_utime) + " earlier"};
}

bool FrameJudge::skip(const std::string& camera, int64_t sequence) {
  const auto known = cameras_.find(camera);
  if (known == cameras_.end()) return false;
  known->second.skipped += sequence > known->second.last.sequence;
  return true;
}

/// False if there are as many cameras as may be, and none is silent.
bool FrameJudge::make_room(int64_t receive_utime, const FrameOptions& options) {
  if (cameras_.size() < static_cast<size_t>(options.max_cameras)) return true;
  const auto quietest = std::min_element(cameras_.begin(), cameras_.end(), [](const auto& a, const auto& b) {
    return a.second.heard < b.second.heard;
  });
  if (receive_utime - quietest->second.heard < kSilence) return false;
  cameras_.erase(quietest);
  return true;
}

}  // namespace edgepose
