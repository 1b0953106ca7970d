// What the master says on the bus: set points, controlwords, SYNC, heartbeat.
#include <algorithm>
#include <cmath>

#include "canopen/cob_id.h"
#include "canopen/master.h"
#include "canopen/nmt.h"

namespace edgepose {

void Master::take_set_points(const PerAxis<double>& set_points, int64_t now_ns) {
  PerAxis<int32_t> next{};
  for (size_t i = 0; i < next.size(); ++i) {
    // A tenth more than the limit, and a count for rounding.
    const double way =
        1.1 * options_.max_velocity[i] * options_.cycle * options_.scale.counts_per_radian() + 1;
    const bool usable = std::isfinite(set_points[i]) && set_points[i] >= options_.min_position[i] - 1e-6 &&
                        set_points[i] <= options_.max_position[i] + 1e-6;
    next[i] = usable ? options_.scale.to_counts(set_points[i]) : targets_[i];
    if (usable && std::abs(static_cast<double>(next[i]) - targets_[i]) <= way) continue;
    return latch(Fault{.kind = FaultKind::kBadSetPoint, .node = state_.axes[i].node, .time_ns = now_ns});
  }
  targets_ = next;
}

/// Where an axis is not in operation its target follows it, so that it does not jump when it is.
void Master::hold() {
  for (size_t i = 0; i < targets_.size(); ++i)
    if (state_.axes[i].state != DriveState::kOperationEnabled) targets_[i] = monitors_[i].counts();
}

uint16_t Master::controlword_for(size_t axis) {
  const DriveState state = state_.axes[axis].state;
  switch (state_.phase) {
    case MasterPhase::kEnabled:
      return controlword::kEnableOperation;
    case MasterPhase::kEnabling: {
      const uint16_t word = controlword_towards_enabled(state);
      // A rising edge resets a fault: one every eight cycles.
      const bool pause = word == controlword::kFaultReset && cycles_in_phase_[axis] % 8 < 4;
      return pause ? controlword::kDisableVoltage : word;
    }
    case MasterPhase::kFault: {
      if (released_) break;
      if (state != DriveState::kOperationEnabled && state != DriveState::kQuickStopActive) break;
      // One that does not obey loses its power: the brake falls.
      const bool obeys =
          state == DriveState::kQuickStopActive || cycles_in_phase_[axis]++ < options_.stop_cycles;
      return obeys ? controlword::kQuickStop : controlword::kDisableVoltage;
    }
    default:
      break;
  }
  return controlword::kDisableVoltage;
}

uint64_t Master::waiting_syncs() {
  const uint64_t unconfirmed = bus_.counters().unconfirmed;
  lost_syncs_ = std::min(lost_syncs_, unconfirmed);  // the bus has forgotten them as well
  return unconfirmed - lost_syncs_;
}

void Master::produce(int64_t now_ns) {
  sync_sent_ = false;
  if (state_.phase == MasterPhase::kIdle) return;
  took_frames_ = true;
  if (now_ns >= next_heartbeat_ns_) {
    put(heartbeat_frame(options_.master_node, NmtState::kOperational, now_ns));
    next_heartbeat_ns_ = now_ns + static_cast<int64_t>(options_.master_heartbeat * 1e9);
  }
  if (!communicating_) return;
  const bool has_fault = state_.phase == MasterPhase::kFault;
  // What is put behind SYNCs that still wait is stale when it is sent.
  if (waiting_syncs() > static_cast<uint64_t>(options_.max_waiting_syncs) && !has_fault)
    took_frames_ = is_down_ = false;
  for (size_t i = 0; i < targets_.size() && (took_frames_ || has_fault); ++i) {
    controlwords_[i] = controlword_for(i);
    const TargetPdo target{
        .controlword = controlwords_[i], .mode = kCyclicSynchronousPosition, .position = targets_[i]};
    // Half a set of targets must not take effect, and ends here; a stop is sent to whom it reaches.
    put(target_frame(options_.nodes[i], target, now_ns));
  }
  if (took_frames_ || has_fault) sync_sent_ = put(sync_frame(now_ns));
  counters_.syncs += sync_sent_;
  // In a row, or again and again: one without room weighs as much as two with it.
  no_room_ = took_frames_ ? std::max(0, no_room_ - 1) : no_room_ + 2;
  if (no_room_ >= 2 * options_.max_no_room)
    latch(is_down_ ? FaultKind::kBusDown : FaultKind::kNoRoom, now_ns,
          static_cast<uint32_t>(options_.max_no_room));
}

bool Master::put(const CanFrame& frame) {
  const SendResult result = bus_.send(frame);
  if (result == SendResult::kSent) return true;
  ++counters_.not_sent;
  took_frames_ = false;
  is_down_ = result == SendResult::kDown;
  return false;
}

void Master::remember(int64_t now_ns) {
  CycleRecord record;
  record.time_ns = now_ns;
  record.controlword = controlwords_;
  for (size_t i = 0; i < state_.axes.size(); ++i) {
    record.target[i] = options_.scale.to_radians(targets_[i]);
    record.position[i] = state_.axes[i].position;
    record.statusword[i] = state_.axes[i].statusword;
  }
  ring_.add(record);
}

}  // namespace edgepose
