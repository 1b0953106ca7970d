#include "canopen/master.h"

#include "canopen/cob_id.h"
#include "canopen/nmt.h"

namespace edgepose {

const char* name_of(MasterPhase phase) {
  switch (phase) {
    case MasterPhase::kIdle:
      return "idle";
    case MasterPhase::kSettingUp:
      return "setting up";
    case MasterPhase::kReady:
      return "ready";
    case MasterPhase::kEnabling:
      return "enabling";
    case MasterPhase::kEnabled:
      return "enabled";
    case MasterPhase::kDisabling:
      return "disabling";
    case MasterPhase::kFault:
      return "fault";
  }
  return "unknown";
}

Master::Master(CanBus& bus, const MasterOptions& options) : bus_(bus), options_(options) {
  options_.check();
  axis_of_node_.fill(-1);
  for (int axis = 0; axis < kAxes; ++axis) {
    set_ups_.push_back(std::make_unique<DriveSetUp>(bus_, options_, axis));
    monitors_.emplace_back(options_, axis);
    axis_of_node_[static_cast<size_t>(options_.nodes[static_cast<size_t>(axis)])] = static_cast<int8_t>(axis);
    state_.axes[static_cast<size_t>(axis)] = monitors_.back().state();
  }
}

bool Master::set_up(int64_t now_ns) {
  if (state_.phase != MasterPhase::kIdle && state_.phase != MasterPhase::kReady) return false;
  begin_set_up(now_ns);
  return true;
}

bool Master::reset(int64_t now_ns) {
  if (state_.phase != MasterPhase::kFault) return false;
  fault_ = {};
  released_ = false;
  set_up_error_.clear();
  ring_.clear();
  begin_set_up(now_ns);
  return true;
}

void Master::begin_set_up(int64_t now_ns) {
  state_.phase = MasterPhase::kSettingUp;
  communicating_ = sync_sent_ = false;
  no_room_ = flooded_ = 0;
  next_heartbeat_ns_ = last_cycle_ns_ = now_ns;
  controlwords_.fill(controlword::kDisableVoltage);
  drop_old_frames(now_ns);
  for (const auto& one : set_ups_) one->begin(now_ns);
}

/// What came before the reset does not answer it: a drive that has just been switched on has said boot-up.
void Master::drop_old_frames(int64_t now_ns) {
  constexpr int kMost = 1 << 14;
  for (int i = 0; i < kMost; ++i) {
    const Received received = bus_.receive(0);
    if (received.kind == Received::Kind::kNothing) return;
    if (received.kind == Received::Kind::kEvent) take_event(received.event, now_ns);
    if (received.kind == Received::Kind::kFrame) take_unwatched(received.frame);
  }
}

/// While nobody watches or sets up, only boot-ups count: who was not told to boot has lost its position.
void Master::take_unwatched(const CanFrame& frame) {
  const int8_t axis = axis_of(frame);
  if (axis < 0 || decode_heartbeat(frame) != NmtState::kBootUp) return;
  DriveSetUp& set_up = *set_ups_[static_cast<size_t>(axis)];
  if (!set_up.awaits_boot_up()) lose_homing(axis);
  set_up.note_boot_up();
}

void Master::lose_homing(int axis) {
  monitors_[static_cast<size_t>(axis)].lose_homing();
  state_.axes[static_cast<size_t>(axis)].homed = monitors_[static_cast<size_t>(axis)].state().homed;
}

EnableResult Master::enable(int64_t now_ns) {
  if (state_.phase != MasterPhase::kReady || !state_.all_fresh) return EnableResult::kNotReady;
  for (const AxisState& axis : state_.axes)
    if (!axis.homed) return EnableResult::kHomingRequired;
  state_.phase = MasterPhase::kEnabling;
  since_ns_.fill(now_ns);
  cycles_in_phase_.fill(0);
  return EnableResult::kBegun;
}

bool Master::disable(int64_t now_ns) {
  if (state_.phase != MasterPhase::kEnabled) return false;
  state_.phase = MasterPhase::kDisabling;
  since_ns_.fill(now_ns);
  cycles_in_phase_.fill(0);
  return true;
}

void Master::stop(int64_t now_ns) { latch(FaultKind::kStopRequested, now_ns); }

void Master::confirm_homed(int axis) {
  monitors_.at(static_cast<size_t>(axis)).confirm_homed();
  state_.axes[static_cast<size_t>(axis)].homed = true;
}

std::string Master::fault_text() const {
  if (!fault_) return "";
  return set_up_error_.empty() ? text_of(fault_) : set_up_error_;
}

void Master::latch(FaultKind kind, int64_t now_ns, uint32_t found) {
  Fault fault;
  fault.kind = kind;
  fault.time_ns = now_ns;
  fault.found = found;
  latch(fault);
}

void Master::latch(const Fault& fault) {
  if (!fault) return;
  if (state_.phase == MasterPhase::kFault) {
    ++counters_.further_faults;
    return;
  }
  fault_ = fault;
  state_.phase = MasterPhase::kFault;
  cycles_in_phase_.fill(0);
}

const ArmState& Master::receive(int64_t now_ns) {
  ++counters_.cycles;
  was_latched_ = state_.phase == MasterPhase::kFault;
  was_enabled_ = state_.phase == MasterPhase::kEnabled;
  take_frames(now_ns);
  if (state_.phase == MasterPhase::kSettingUp) continue_set_up(now_ns);
  if (communicating_) judge(now_ns);
  if (state_.phase == MasterPhase::kEnabling || state_.phase == MasterPhase::kDisabling) transit(now_ns);
  return state_;
}

const ArmState& Master::send(int64_t now_ns, const PerAxis<double>& set_points) {
  // Who calls knows only from the next cycle on that set points count.
  if (was_enabled_ && state_.phase == MasterPhase::kEnabled)
    take_set_points(set_points, now_ns);
  else
    hold();
  produce(now_ns);
  if (!was_latched_) remember(now_ns);
  last_cycle_ns_ = now_ns;
  return state_;
}

void Master::take_frames(int64_t now_ns) {
  int frames = 0;
  for (; frames < options_.max_frames_a_cycle; ++frames) {
    const Received received = bus_.receive(0);
    if (received.kind == Received::Kind::kNothing) break;
    if (received.kind == Received::Kind::kFrame)
      dispatch(received.frame, now_ns);
    else
      take_event(received.event, now_ns);
  }
  flooded_ = frames == options_.max_frames_a_cycle ? flooded_ + 1 : 0;
  if (flooded_ >= 3) latch(FaultKind::kFlooded, now_ns, static_cast<uint32_t>(frames));
}

int8_t Master::axis_of(const CanFrame& frame) const {
  return axis_of_node_[static_cast<size_t>(cob_id::node_of(frame.id))];
}

void Master::dispatch(const CanFrame& frame, int64_t now_ns) {
  const int8_t axis = axis_of(frame);
  if (axis < 0) return;
  if (state_.phase == MasterPhase::kSettingUp)
    set_ups_[static_cast<size_t>(axis)]->take(frame, now_ns);
  else if (communicating_)
    latch(monitors_[static_cast<size_t>(axis)].take(frame, now_ns));
  else
    take_unwatched(frame);
}

void Master::take_event(BusEvent event, int64_t now_ns) {
  if (state_.phase == MasterPhase::kIdle) return;
  if (event == BusEvent::kBusOff) latch(FaultKind::kBusOff, now_ns);
  if (event == BusEvent::kDown || event == BusEvent::kEnd) latch(FaultKind::kBusDown, now_ns);
}

void Master::continue_set_up(int64_t now_ns) {
  bool all_done = true;
  for (int axis = 0; axis < kAxes; ++axis) {
    const auto& one = set_ups_[static_cast<size_t>(axis)];
    one->tick(now_ns);
    all_done = all_done && one->state() == DriveSetUp::State::kDone;
    if (one->state() != DriveSetUp::State::kFailed) continue;
    if (one->found_duplicate()) lose_homing(axis);
    if (state_.phase != MasterPhase::kFault) set_up_error_ = one->error();
    latch(one->found_duplicate() ? FaultKind::kDuplicateNode : FaultKind::kSetUp, now_ns);
  }
  if (!all_done || state_.phase == MasterPhase::kFault) return;
  for (AxisMonitor& monitor : monitors_) monitor.begin(now_ns);
  communicating_ = true;
  // Requests that were put behind them have been answered: a queue that was thrown away took them along.
  lost_syncs_ = bus_.counters().unconfirmed;
  last_cycle_ns_ = now_ns;
  state_.phase = MasterPhase::kReady;
}

void Master::judge(int64_t now_ns) {
  const bool is_enabled = state_.phase == MasterPhase::kEnabled;
  const auto patience = static_cast<int64_t>((options_.max_missed + 1) * options_.cycle * 1e9);
  const bool overrun = state_.phase != MasterPhase::kFault && now_ns - last_cycle_ns_ > patience;
  state_.all_fresh = true;
  for (size_t i = 0; i < monitors_.size(); ++i) {
    latch(monitors_[i].judge(now_ns, sync_sent_, targets_[i], is_enabled));
    state_.axes[i] = monitors_[i].state();
    state_.all_fresh = state_.all_fresh && state_.axes[i].fresh;
  }
  if (overrun) latch(FaultKind::kOverrun, now_ns);
}

/// The way to operation enabled, or to no power: each step has its deadline from the last change of state on.
void Master::transit(int64_t now_ns) {
  const bool enabling = state_.phase == MasterPhase::kEnabling;
  const DriveState goal = enabling ? DriveState::kOperationEnabled : DriveState::kSwitchOnDisabled;
  bool all_there = true;
  for (size_t i = 0; i < monitors_.size(); ++i) {
    const AxisState& axis = state_.axes[i];
    ++cycles_in_phase_[i];
    if (axis.state != last_states_[i]) since_ns_[i] = now_ns;
    last_states_[i] = axis.state;
    all_there = all_there && axis.fresh && axis.state == goal;
    if (axis.state == goal) {
      since_ns_[i] = now_ns;
    } else if (now_ns - since_ns_[i] > static_cast<int64_t>(options_.transition_timeout * 1e9)) {
      Fault late{
          .kind = FaultKind::kTransition, .node = axis.node, .time_ns = now_ns, .found = axis.statusword};
      late.expected = enabling ? next_state_towards_enabled(axis.state) : goal;
      late.after_ns = now_ns - since_ns_[i];
      latch(late);
    }
  }
  if (all_there && state_.phase != MasterPhase::kFault)
    state_.phase = enabling ? MasterPhase::kEnabled : MasterPhase::kReady;
}

}  // namespace edgepose
