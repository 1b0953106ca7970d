#include "controller/arm_controller.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace edgepose {
namespace {

FaultCause cause_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::kBusOff:
    case FaultKind::kBusDown:
    case FaultKind::kNoRoom:
    case FaultKind::kFlooded:
    case FaultKind::kOverrun:
      return FaultCause::kBus;
    case FaultKind::kFollowingError:
    case FaultKind::kStuck:
      return FaultCause::kFollowing;
    default:
      return FaultCause::kDrive;
  }
}

constexpr double kMoving = 0.01;             // [rad/s]
constexpr int64_t kRest = 100'000'000;       // [ns] without motion
constexpr int64_t kBlindRest = 500'000'000;  // [ns] after a fault, where the joints are no longer measured

}  // namespace

MasterOptions master_options_for(const ArmGeometry& arm, const ServoOptions& servo, MasterOptions options) {
  options.cycle = servo.motion.cycle;
  for (int i = 0; i < kJoints; ++i) {
    const auto axis = static_cast<size_t>(i);
    options.min_position[axis] = arm.lower[i];
    options.max_position[axis] = arm.upper[i];
    options.max_velocity[axis] = arm.max_velocity[i];
  }
  return options;
}

ArmController::ArmController(CanBus& bus, const ArmGeometry& arm, const ToldCalibration& told,
                             const RigidTransform& camera_T_tool, const ServoOptions& servo,
                             const MasterOptions& master)
    : servo_(arm, told, camera_T_tool, servo), master_(bus, master_options_for(arm, servo, master)) {}

const ControlSample& ArmController::cycle(int64_t now_ns, const std::optional<PoseReading>& reading) {
  master_.receive(now_ns);
  see_joints(now_ns);
  take_faults();
  work_on_request(now_ns);
  const double state_age = 1e-9 * static_cast<double>(now_ns - state_ns_);
  sample_.servo = servo_.cycle(1e-9 * static_cast<double>(now_ns), measured(), reading, state_age);
  take_power_off(now_ns);
  PerAxis<double> set_points{};
  for (int i = 0; i < kJoints; ++i) set_points[static_cast<size_t>(i)] = sample_.servo.command.position[i];
  master_.send(now_ns, set_points);
  last_sync_ns_ = now_ns;
  take_faults();

  sample_.time_ns = now_ns;
  sample_.servo.state = servo_.state();
  sample_.phase = master_.state().phase;
  sample_.fault = servo_.fault();
  for (size_t i = 0; i < kAxes; ++i) sample_.statusword[i] = master_.state().axes[i].statusword;
  if (sample_.servo.verdict)
    ++(*sample_.servo.verdict == PoseVerdict::kTaken ? sample_.poses_taken : sample_.poses_refused);
  return sample_;
}

bool ArmController::request(const ArmRequest& request) {
  if (request_ || answer_) return false;
  request_ = request;
  arming_ = false;
  return true;
}

std::optional<std::string> ArmController::take_answer() { return std::exchange(answer_, std::nullopt); }

void ArmController::stop(int64_t now_ns) {
  if (request_) answer("stopped before it was done");
  arming_ = false;
  servo_.stop();
  if (master_.state().phase == MasterPhase::kEnabling) master_.stop(now_ns);
}

std::string ArmController::fault_text() const {
  if (servo_.state() != ServoState::kFault) return "";
  return std::string(fault_name(servo_.fault())) + ": " + servo_.fault_detail();
}

void ArmController::answer(const std::string& text) {
  request_.reset();
  answer_ = text;
}

void ArmController::work_on_request(int64_t now_ns) {
  if (!request_) return;
  switch (request_->command) {
    case ArmCommand::kArm:
      return continue_arming(now_ns);
    case ArmCommand::kGo:
      return answer(servo_.go(request_->goal, 1e-9 * static_cast<double>(now_ns)));
    case ArmCommand::kReset:
      return reset(now_ns);
    case ArmCommand::kHomed:
      if (servo_.state() != ServoState::kIdle) return answer("homed is refused unless idle");
      for (int axis = 0; axis < kAxes; ++axis) master_.confirm_homed(axis);
      return answer("");
  }
}

/// Through the master's phases to armed; each has its own deadlines there.
void ArmController::continue_arming(int64_t now_ns) {
  if (servo_.state() != ServoState::kIdle) {
    const std::string fault = fault_text();
    if (arming_ && !fault.empty()) return answer(fault);
    return answer("arm is refused while " + std::string(state_name(servo_.state())) +
                  (fault.empty() ? "" : " (" + fault + ")") + "; reset comes first");
  }
  arming_ = true;
  switch (master_.state().phase) {
    case MasterPhase::kIdle:
      master_.set_up(now_ns);
      return;
    case MasterPhase::kReady:
      if (master_.enable(now_ns) == EnableResult::kHomingRequired)
        return answer(
            "arm is refused: a drive has booted by itself, or is where it cannot have "
            "come to: its position must be made sure of; then say homed");
      return;
    case MasterPhase::kEnabled:
      arming_ = false;
      return answer(servo_.arm(measured()));
    case MasterPhase::kFault:
      return answer(master_.fault_text());
    default:
      return;
  }
}

void ArmController::reset(int64_t now_ns) {
  // Setting drives up anew would let go of them while they brake.
  if (master_.state().phase == MasterPhase::kFault && is_moving(now_ns))
    return answer("reset is refused while the arm comes to rest");
  std::string refusal = servo_.reset();
  if (refusal.empty()) {
    drives_fault_told_ = false;
    master_.reset(now_ns);
  }
  answer(refusal);
}

/// A fault of bus or drives is one of the loop: it must not go on as if they followed.
void ArmController::take_faults() {
  const bool is_fault = master_.state().phase == MasterPhase::kFault;
  if (!is_fault || drives_fault_told_) {
    drives_fault_told_ = is_fault;
    return;
  }
  drives_fault_told_ = true;
  fault_ns_ = sample_.time_ns;
  servo_.fail(cause_of(master_.fault().kind), master_.fault_text(), true);
}

/// Where nothing may move and nothing does, motors have no power.
void ArmController::take_power_off(int64_t now_ns) {
  const MasterPhase phase = master_.state().phase;
  if (phase != MasterPhase::kEnabled) return;
  const ServoState state = servo_.state();
  const bool disobeys = servo_.fault() == FaultCause::kFollowing || servo_.fault() == FaultCause::kBadState;
  if (state == ServoState::kFault && disobeys) return master_.stop(now_ns);
  const bool off = state == ServoState::kFault || state == ServoState::kStopped ||
                   (state == ServoState::kIdle && !arming_);
  if (off && edgepose::at_rest(sample_.servo.command)) master_.disable(now_ns);
}

/// As far as it is known: the joints have moved a moment ago, or are not heard of so soon after a fault.
bool ArmController::is_moving(int64_t now_ns) const {
  if (now_ns - last_motion_ns_ < kRest) return true;
  return !master_.state().all_fresh && now_ns - fault_ns_ < kBlindRest;
}

void ArmController::see_joints(int64_t now_ns) {
  const MasterPhase phase = master_.state().phase;
  if (phase == MasterPhase::kIdle || phase == MasterPhase::kSettingUp)
    joints_known_ = false;
  else if (master_.state().all_fresh)
    joints_known_ = true;
  if (!joints_known_ || !master_.state().all_fresh) return;
  const JointVector now = measured();
  const double cycle = 1e-9 * static_cast<double>(std::max<int64_t>(last_sync_ns_ - state_ns_, 1));
  if ((now - last_measured_).cwiseAbs().maxCoeff() > kMoving * cycle) last_motion_ns_ = now_ns;
  last_measured_ = now;
  state_ns_ = last_sync_ns_;
}

/// Not a number where it is not known: a pose must never be placed by an arm that was not measured.
JointVector ArmController::measured() const {
  JointVector position = JointVector::Constant(std::numeric_limits<double>::quiet_NaN());
  if (!joints_known_) return position;
  for (int i = 0; i < kJoints; ++i) position[i] = master_.state().axes[static_cast<size_t>(i)].position;
  return position;
}

}  // namespace edgepose
