#include "canopen/drive.h"

#include <algorithm>

#include "canopen/cob_id.h"
#include "canopen/drive_dictionary.h"
#include "canopen/drive_pdo.h"

namespace edgepose {
namespace {

constexpr int64_t kMillisecond = 1'000'000;
constexpr int64_t kMaxCatchUp = 2'000 * kMillisecond;
/// SYNCs that may be missing in a row, and a little: three pass, ten do not.
constexpr double kSyncPatience = 4.8;

}  // namespace

Drive::Drive(CanBus& bus, const DriveOptions& options, int64_t now_ns)
    : bus_(bus),
      options_(options),
      objects_(make_drive_dictionary(options)),
      axis_(objects_, options_),
      sdo_(objects_, options.node),
      time_ns_(now_ns) {
  boot();
}

/// All objects have their defaults again; boot-up with the next step.
void Drive::boot() {
  objects_ = make_drive_dictionary(options_);
  objects_.set_guard([this](ObjectId id, int64_t value) { return check_pdo_write(objects_, id, value); });
  axis_.refresh();
  sdo_.reset();
  nmt_ = NmtState::kBootUp;
  rpdo_waits_ = false;
  syncs_ = 0;
  rpdo_deadline_.disarm();
  sync_deadline_.disarm();
  master_deadline_.disarm();
}

void Drive::power_cycle() {
  axis_.restart();
  boot();
}

void Drive::provoke(Provocation kind, bool on) {
  if (kind == Provocation::kEmergency) return axis_.fail(emergency_code::kOverTemperature);
  if (kind == Provocation::kReboot) return power_cycle();
  if (kind >= Provocation::kCount) return;
  provoked_[static_cast<size_t>(kind)] = on;
  axis_.set_mobility(is(Provocation::kJam) ? 0 : is(Provocation::kDrag) ? 0.01 : 1);
  axis_.ignore_controlword(is(Provocation::kIgnoresController));
  if (kind == Provocation::kDead) power_cycle();
}

void Drive::step(int64_t now_ns) {
  constexpr int kMaxFrames = 1024;
  for (int i = 0; i < kMaxFrames; ++i) {
    const Received received = bus_.receive(0);
    if (received.kind == Received::Kind::kNothing) break;
    if (received.kind == Received::Kind::kFrame) take(received.frame, now_ns);
  }
  advance(now_ns);
}

void Drive::take(const CanFrame& frame, int64_t now_ns) {
  if (is(Provocation::kDead)) return;
  if (const auto message = decode_nmt(frame)) {
    if (message->node == 0 || message->node == options_.node) obey(*message);
    return;
  }
  if (nmt_ == NmtState::kBootUp) return;
  // Bits 16 to 22 of 1016: whose heartbeat; 0 to 15: within how many ms.
  const int64_t consumer = objects_.value(object::kConsumerHeartbeat);
  if (frame.id == cob_id::kHeartbeat + (consumer >> 16 & 0x7f) && consumer >> 16 != 0)
    master_deadline_.feed(now_ns);
  if (nmt_ == NmtState::kStopped) return;
  if (const auto answer = sdo_.answer(frame, now_ns)) {
    if (!is(Provocation::kNoSdo)) say(*answer);
    return;
  }
  if (nmt_ != NmtState::kOperational) return;
  if (is_sync(frame) && frame.id == (objects_.value(object::kSyncCobId) & CanFrame::kMaxId)) {
    synchronise(now_ns);
  } else if (frame.id ==
             objects_.value({object::kRpdoCommunication, 1})) {  // the top bit is set if it is off
    rpdo_ = frame;
    rpdo_waits_ = true;
    rpdo_deadline_.feed(now_ns);
    if (objects_.value({object::kRpdoCommunication, 2}) > 240) synchronise(now_ns);
  }
}

void Drive::obey(const NmtMessage& message) {
  if (nmt_ == NmtState::kBootUp) return;
  switch (message.command) {
    case NmtCommand::kStart:
      nmt_ = NmtState::kOperational;
      break;
    case NmtCommand::kStop:
    case NmtCommand::kEnterPreOperational:
      nmt_ = message.command == NmtCommand::kStop ? NmtState::kStopped : NmtState::kPreOperational;
      rpdo_deadline_.disarm();
      sync_deadline_.disarm();
      if (axis_.state() == DriveState::kOperationEnabled)
        axis_.lose_connection(emergency_code::kNodeGuarding);
      break;
    case NmtCommand::kResetNode:
      power_cycle();
      break;
    case NmtCommand::kResetCommunication:  // power off, but a fault of the drive stays one
      axis_.cut_power();
      boot();
      break;
  }
}

/// SYNC (CiA 301, 7.2.5): what was measured goes out, what came in takes effect.
void Drive::synchronise(int64_t now_ns) {
  sync_deadline_.feed(now_ns);
  ++syncs_;
  axis_.refresh();
  for (const int number : {0, 1}) {
    const auto communication = static_cast<uint16_t>(object::kTpdoCommunication + number);
    const auto every = static_cast<uint64_t>(std::max<int64_t>(1, objects_.value({communication, 2})));
    if (syncs_ % every == 0) send_tpdo(number, now_ns);
  }
  if (!rpdo_waits_) return;
  rpdo_waits_ = false;
  if (unpack_pdo(objects_, object::kRpdoMapping, rpdo_)) axis_.apply();
}

void Drive::send_tpdo(int number, int64_t now_ns) {
  const int64_t cob = objects_.value({static_cast<uint16_t>(object::kTpdoCommunication + number), 1});
  if (cob > CanFrame::kMaxId || is(Provocation::kNoTpdo)) return;
  CanFrame frame{.id = static_cast<uint16_t>(cob), .size = 0, .data = {}, .time_ns = now_ns};
  pack_pdo(objects_, static_cast<uint16_t>(object::kTpdoMapping + number), frame);
  if (number == 0 && is(Provocation::kFrozenState) && last_tpdo1_.id == frame.id)
    frame.data = last_tpdo1_.data;
  if (number == 0) last_tpdo1_ = frame;
  say(frame);
}

void Drive::advance(int64_t now_ns) {
  time_ns_ = std::max(time_ns_, now_ns - kMaxCatchUp);
  while (time_ns_ < now_ns) {
    const int64_t step = std::min(now_ns - time_ns_, kMillisecond);
    time_ns_ += step;
    axis_.advance(static_cast<double>(step) * 1e-9);
    watch(time_ns_);
  }
  if (nmt_ == NmtState::kBootUp && !is(Provocation::kDead)) {
    say(heartbeat_frame(options_.node, NmtState::kBootUp, now_ns));
    nmt_ = NmtState::kPreOperational;
    next_heartbeat_ns_ = now_ns;
  }
  while (const auto emergency = axis_.take_emergency())
    say(emergency_frame(options_.node, *emergency, now_ns));
  const int64_t period = objects_.value(object::kProducerHeartbeat) * kMillisecond;
  if (period == 0 || now_ns < next_heartbeat_ns_) return;
  next_heartbeat_ns_ += period;
  if (next_heartbeat_ns_ <= now_ns) next_heartbeat_ns_ = now_ns + period;
  if (!is(Provocation::kNoHeartbeat)) say(heartbeat_frame(options_.node, nmt_, now_ns));
}

void Drive::watch(int64_t now_ns) {
  const int64_t rpdo = objects_.value({object::kRpdoCommunication, 5}) * kMillisecond;
  if (rpdo_deadline_.expires(now_ns, rpdo)) lose(emergency_code::kRpdoTimeout);
  const double cycle = static_cast<double>(objects_.value(object::kCyclePeriod)) * 1e3;
  if (sync_deadline_.expires(now_ns, static_cast<int64_t>(kSyncPatience * cycle)))
    lose(emergency_code::kSyncMissing);
  const int64_t master = (objects_.value(object::kConsumerHeartbeat) & 0xffff) * kMillisecond;
  if (master_deadline_.expires(now_ns, master)) lose(emergency_code::kNodeGuarding);
}

/// 1029:01 says what becomes of the NMT state: 0 pre-operational, 1 nothing, 2 stopped.
void Drive::lose(uint16_t code) {
  axis_.lose_connection(code);
  const int64_t behaviour = objects_.value(object::kErrorBehaviour);
  if (nmt_ != NmtState::kOperational || behaviour == 1) return;
  nmt_ = behaviour == 0 ? NmtState::kPreOperational : NmtState::kStopped;
}

void Drive::say(CanFrame frame) {
  if (!is(Provocation::kDead)) bus_.send(frame);
}

}  // namespace edgepose
