#include "server/tracker.h"

#include <algorithm>

namespace edgepose {
namespace {

constexpr size_t kMaxMemories = 4096;  // cameras times models; beyond, all are forgotten and detected again
constexpr int64_t kLongPause =
    2'000'000;  // [us] whatever the numbers say, something else may be there by now

}  // namespace

Tracker::Key Tracker::key_of(const RegisteredModel& model, const FrameMark& frame) {
  return {frame.camera, model.name, model.content_hash};
}

const Tracker::Memory* Tracker::find(const RegisteredModel& model, const FrameMark& frame,
                                     const TrackingOptions& options) const {
  if (!options.enabled) return nullptr;
  const auto known = memories_.find(key_of(model, frame));
  if (known == memories_.end()) return nullptr;
  const Memory& memory = known->second;
  const double missing = static_cast<double>(frame.sequence) - static_cast<double>(memory.sequence) - 1;
  const bool is_near =
      missing >= 0 && missing <= options.max_gap && frame.capture_utime - memory.capture_utime <= kLongPause;
  return is_near ? &memory : nullptr;
}

bool Tracker::is_due(const Memory& memory, const TrackingOptions& options) {
  return memory.since_detection + 1 >= options.detect_every;
}

void Tracker::remember(const RegisteredModel& model, const FrameMark& frame, const MatchResult& result,
                       bool was_detected) {
  const Key key = key_of(model, frame);
  Memory seen;
  for (const Detection& d : result.detections) {
    if (!d.accepted) continue;
    seen.instances.push_back({d.camera_T_model, d.sightings});
    seen.margins.push_back(d.margin);
  }
  if (seen.instances.empty()) {
    memories_.erase(key);
    return;
  }
  if (memories_.size() >= kMaxMemories && !memories_.contains(key)) memories_.clear();
  Memory& memory = memories_[key];
  seen.since_detection = was_detected ? 0 : memory.since_detection + 1;
  seen.sequence = frame.sequence;
  seen.capture_utime = frame.capture_utime;
  memory = std::move(seen);
}

}  // namespace edgepose
