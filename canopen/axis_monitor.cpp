#include "canopen/axis_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "canopen/cob_id.h"

namespace edgepose {

AxisMonitor::AxisMonitor(const MasterOptions& options, int axis) : options_(options) {
  state_.node = options.nodes[static_cast<size_t>(axis)];
}

void AxisMonitor::begin(int64_t now_ns) {
  heartbeat_ns_ = now_ns;
  states_ = surplus_ = same_ = state_.missed = 0;
  has_state_ = state_.fresh = false;
}

Fault AxisMonitor::fault(FaultKind kind, int64_t now_ns, uint32_t found) const {
  Fault made;
  made.kind = kind;
  made.node = state_.node;
  made.time_ns = now_ns;
  made.found = found;
  return made;
}

Fault AxisMonitor::take(const CanFrame& frame, int64_t now_ns) {
  if (const auto state = decode_state(frame)) {
    ++states_;
    take_state(*state, target_);
  } else if (const auto motion = decode_motion(frame)) {
    state_.velocity = options_.scale.to_radians(motion->velocity);
    state_.torque = motion->torque * 1e-3;
  } else if (const auto heartbeat = decode_heartbeat(frame)) {
    return take_heartbeat(*heartbeat, now_ns);
  } else if (const auto emergency = decode_emergency(frame);
             emergency && emergency->code != emergency_code::kNone) {
    return fault(FaultKind::kEmergency, now_ns, emergency->code);
  }
  return {};
}

void AxisMonitor::take_state(const StatePdo& state, int32_t target) {
  // Flags such as target reached are no sign that the axis lives.
  const bool same = has_state_ && state.position == last_.position &&
                    state_of(state.statusword) == state_of(last_.statusword);
  same_ = same ? same_ + 1 : 0;
  if (!same) target_when_changed_ = target;
  const double position = options_.scale.to_radians(state.position);
  if (!has_state_ && is_placed_) state_.homed = state_.homed && is_where_it_was(position);
  last_ = state;
  has_state_ = is_placed_ = true;
  state_.statusword = state.statusword;
  state_.state = state_of(state.statusword);
  state_.position = position;
}

/// As far as an axis may have come while nobody listened: braking from its last velocity, and sagging.
bool AxisMonitor::is_where_it_was(double position) const {
  constexpr double kReaction = 0.1;  // [s] until it brakes
  const double v = std::abs(state_.velocity);
  const double braking = v * kReaction + v * v / (2 * options_.quick_stop_deceleration);
  return std::abs(position - state_.position) <= options_.following_window + braking;
}

Fault AxisMonitor::take_heartbeat(NmtState state, int64_t now_ns) {
  heartbeat_ns_ = now_ns;
  if (state == NmtState::kBootUp) {
    state_.homed = false;
    return fault(FaultKind::kRebooted, now_ns);
  }
  if (state == NmtState::kOperational) return {};
  Fault found = fault(FaultKind::kNotOperational, now_ns);
  found.nmt = state;
  return found;
}

Fault AxisMonitor::judge(int64_t now_ns, bool expects_state, int32_t target, bool is_enabled) {
  target_ = target;
  state_.fresh = states_ > 0;
  if (expects_state) {
    const bool missed = states_ == 0;
    state_.missed = missed ? state_.missed + 1 : 0;
    state_.missed_ever += missed;
    // One that was late comes together with the next: the sum tells two nodes from one.
    surplus_ = std::max(surplus_ + states_ - 1, -options_.max_missed);
  }
  states_ = 0;
  if (surplus_ > options_.max_missed) return fault(FaultKind::kDuplicateNode, now_ns);
  if (state_.missed > options_.max_missed)
    return fault(FaultKind::kLostState, now_ns, static_cast<uint32_t>(state_.missed));
  const int64_t silent = now_ns - heartbeat_ns_;
  if (silent > static_cast<int64_t>(options_.drive_heartbeat_timeout * 1e9)) {
    Fault lost = fault(FaultKind::kHeartbeat, now_ns);
    lost.after_ns = silent;
    return lost;
  }
  return is_enabled && state_.fresh ? judge_motion(now_ns, target) : Fault{};
}

Fault AxisMonitor::judge_motion(int64_t now_ns, int32_t target) const {
  const uint16_t word = state_.statusword;
  if (state_.state != DriveState::kOperationEnabled || last_.mode != kCyclicSynchronousPosition) {
    Fault left = fault(FaultKind::kUnexpectedState, now_ns, word);
    left.expected = DriveState::kOperationEnabled;
    return left;
  }
  const auto away = [&](int32_t from) {
    return std::abs(options_.scale.to_radians(target) - options_.scale.to_radians(from));
  };
  if (word & statusword::kFollowingError || away(last_.position) > options_.master_following_window)
    return fault(FaultKind::kFollowingError, now_ns, word);
  if (same_ >= options_.stuck_cycles && away(target_when_changed_) > options_.stuck_motion)
    return fault(FaultKind::kStuck, now_ns, word);
  return {};
}

}  // namespace edgepose
