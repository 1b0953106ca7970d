#include "server/tracker.h"

#include <algorithm>

namespace edgepose {
namespace {

constexpr size_t kMaxMemories = 4096;  // cameras times models; beyond, all are forgotten and detected again

}  // namespace

const Tracker::Memory* Tracker::find(const std::string& camera, const RegisteredModel& model,
                                     int64_t sequence, const TrackingOptions& options) const {
  if (!options.enabled) return nullptr;
  const auto known = memories_.find({camera, model.content_hash});
  if (known == memories_.end()) return nullptr;
  const double missing = static_cast<double>(sequence) - static_cast<double>(known->second.sequence) - 1;
  return missing >= 0 && missing <= options.max_gap ? &known->second : nullptr;
}

bool Tracker::is_due(const Memory& memory, const TrackingOptions& options) {
  return memory.since_detection + 1 >= options.detect_every;
}

void Tracker::remember(const std::string& camera, const RegisteredModel& model, int64_t sequence,
                       const MatchResult& result, bool was_detected) {
  const Key key{camera, model.content_hash};
  std::vector<TrackStart> instances;
  for (const Detection& d : result.detections)
    if (d.accepted) instances.push_back({d.camera_T_model, d.sightings});
  if (instances.empty()) {
    memories_.erase(key);
    return;
  }
  if (memories_.size() >= kMaxMemories && !memories_.contains(key)) memories_.clear();
  Memory& memory = memories_[key];
  memory.since_detection = was_detected ? 0 : memory.since_detection + 1;
  memory.instances = std::move(instances);
  memory.sequence = sequence;
}

}  // namespace edgepose
