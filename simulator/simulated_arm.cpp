#include "simulator/simulated_arm.h"

#include <algorithm>
#include <string_view>

#include "canopen/nmt.h"
#include "common/error.h"
#include "matcher/option_range.h"

namespace edgepose {
namespace {

constexpr std::array<std::string_view, static_cast<size_t>(Provocation::kCount)> kProvocations{
    "emergency",          "reboot",       "jam",     "drag",   "frozen_state",
    "ignores_controller", "no_heartbeat", "no_tpdo", "no_sdo", "dead"};

}  // namespace

std::optional<Provocation> provocation_named(const std::string& name) {
  const auto found = std::find(kProvocations.begin(), kProvocations.end(), name);
  if (found == kProvocations.end()) return std::nullopt;
  return static_cast<Provocation>(found - kProvocations.begin());
}

std::string provocation_names() {
  std::string names;
  for (const std::string_view name : kProvocations) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

std::string SimulatedArmOptions::check() const {
  if (!start.allFinite()) return "start: expected finite joint positions, found NaN or inf";
  return option_fault({{"start", start.cwiseAbs().maxCoeff(), 0, 6.3},
                       {"scale.counts_per_turn", scale.counts_per_turn, 1000, 1e8},
                       {"lag", lag, 0.0001, 1},
                       {"duplicate_axis", static_cast<double>(duplicate_axis), -1, kJoints - 1},
                       {"absent_axis", static_cast<double>(absent_axis), -1, kJoints - 1}});
}

SimulatedArm::SimulatedArm(CanBus& bus, const SimulatedArmOptions& options, int64_t now_ns) : bus_(bus) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("arm: " + fault);
  for (int axis = 0; axis < kJoints; ++axis) {
    DriveOptions drive;
    drive.node = axis + 1;
    drive.identity = options.identities[static_cast<size_t>(axis)];
    drive.scale = options.scale;
    drive.position = options.start[axis];
    drive.lag = options.lag;
    drive.sag = options.sag[axis];
    drives_[static_cast<size_t>(axis)] = std::make_unique<Drive>(bus, drive, now_ns);
    if (axis == options.duplicate_axis) duplicate_ = std::make_unique<Drive>(bus, drive, now_ns);
    if (axis == options.absent_axis) provoke(axis, Provocation::kDead);
  }
}

bool SimulatedArm::step(int64_t now_ns) {
  // A flooded bus must not stop the drives' clocks.
  constexpr int kMaxFrames = 4096;
  bool ended = false;
  for (int i = 0; i < kMaxFrames; ++i) {
    const Received received = bus_.receive(0);
    if (received.kind == Received::Kind::kNothing) break;
    if (received.kind == Received::Kind::kFrame) take(received.frame, now_ns);
    ended = ended || received.event == BusEvent::kDown;
  }
  for (const auto& drive : drives_) drive->advance(now_ns);
  if (duplicate_) duplicate_->advance(now_ns);
  return ended;
}

void SimulatedArm::take(const CanFrame& frame, int64_t now_ns) {
  ++frames_;
  if (syncs_to_drop_ > 0 && is_sync(frame)) {
    --syncs_to_drop_;
    return;
  }
  for (const auto& drive : drives_) drive->take(frame, now_ns);
  if (duplicate_) duplicate_->take(frame, now_ns);
}

JointVector SimulatedArm::position() const {
  JointVector joints;
  for (int axis = 0; axis < kJoints; ++axis) joints[axis] = drive(axis).position();
  return joints;
}

JointVector SimulatedArm::velocity() const {
  JointVector joints;
  for (int axis = 0; axis < kJoints; ++axis) joints[axis] = drive(axis).velocity();
  return joints;
}

}  // namespace edgepose
