#include "servoing/servo.h"

#include <Eigen/Geometry>
#include <cmath>

#include "arm/kinematics.h"
#include "arm/rigid_motion.h"
#include "common/error.h"
#include "matcher/option_range.h"
#include "servoing/proper_pose.h"

namespace edgepose {
namespace {

/// `estimate` moved by `share` of the way to `found`.
RigidTransform blended(const RigidTransform& estimate, const RigidTransform& found, double share) {
  const Eigen::Vector3d turn = rotation_vector(estimate.linear().transpose() * found.linear());
  return rigid_transform(estimate.linear() * rotation_matrix(share * turn),
                         estimate.translation() + share * (found.translation() - estimate.translation()));
}

RigidTransform stood_off(const RigidTransform& model_T_tool, double standoff) {
  return model_T_tool * Eigen::Translation3d(0, 0, -standoff);
}

}  // namespace

Servo::Servo(const ArmGeometry& arm, const ToldCalibration& told, const RigidTransform& camera_T_tool,
             const ServoOptions& options)
    : geometry_(arm),
      told_(told),
      camera_T_tool_(camera_T_tool),
      options_(options),
      history_(options.history),
      gate_(options.gate),
      convergence_(options.approach) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("servo." + fault);
  for (const RigidTransform& transform : {told.flange_T_camera, told.flange_T_tool, camera_T_tool})
    if (!is_proper(transform))
      throw InputError("servo: expected rigid transforms of camera and tool, found another");
}

std::string Servo::command(ServoEvent event) {
  const std::optional<ServoState> next = transition(state_, event);
  if (!next) return std::string(event_name(event)) + " is refused while " + state_name(state_);
  state_ = *next;
  return "";
}

std::string Servo::arm(const JointVector& measured) {
  if (!measured.allFinite()) return "arm is refused: the arm's position is not known";
  for (int i = 0; i < kJoints; ++i) {
    const AxisLimits limits = axis_limits(geometry_, options_.motion, i);
    if (measured[i] < limits.lower || measured[i] > limits.upper)
      return "arm is refused: joint " + std::to_string(i + 1) + " is beyond its limit; move it back by hand";
  }
  if (std::string refusal = command(ServoEvent::kArm); !refusal.empty()) return refusal;
  command_ = {measured, JointVector::Zero(), JointVector::Zero()};
  base_T_model_.reset();
  poses_taken_ = 0;
  gate_.forget_sequence();  // a camera that was started again counts anew
  return "";
}

std::string Servo::go(const ServoGoal& goal, double now) {
  if (!goal.entry.allFinite() || !(std::abs(goal.axis.norm() - 1) < 1e-6))
    return "go is refused: the target is no point with a unit axis";
  if (std::string refusal = command(ServoEvent::kGo); !refusal.empty()) return refusal;
  goal_ = goal;
  goal_chosen_ = false;
  standoff_ = options_.approach.standoff;
  go_time_ = last_capture_ = now;
  poses_since_go_ = 0;  // what was seen before says nothing of where the model is now
  blocked_since_ = -1;
  convergence_.restart();
  return "";
}

std::string Servo::stop() { return command(ServoEvent::kStop); }

std::string Servo::reset() {
  if (!drives_off_ && !at_rest(command_)) return "reset is refused while the arm comes to rest";
  if (std::string refusal = command(ServoEvent::kReset); !refusal.empty()) return refusal;
  fault_ = FaultCause::kNone;
  fault_detail_.clear();
  drives_off_ = false;
  fault_samples_.clear();
  return "";
}

void Servo::fail(FaultCause cause, const std::string& detail, bool drives_off) {
  drives_off_ = drives_off_ || drives_off;
  if (state_ == ServoState::kFault) return;  // the first cause is the one to name
  command(ServoEvent::kFailed);
  fault_samples_ = samples_;
  fault_ = cause;
  fault_detail_ = detail;
}

const ServoSample& Servo::cycle(double now, const JointVector& measured,
                                const std::optional<PoseReading>& reading, double state_age) {
  ServoSample sample;
  sample.time = now;
  state_time_ = now - state_age;
  sample.measured = measured;
  check_arm(sample);
  if (reading && state_ != ServoState::kIdle) take_pose(*reading, sample);
  check_times(sample);
  if (may_move(state_) && base_T_model_ && poses_since_go_ >= options_.confirming_poses)
    move(sample);
  else
    command_ = stop_motion(command_, options_.motion);
  // Nothing is commanded here: the command is where the arm is, so that it starts from there.
  if ((state_ == ServoState::kIdle || drives_off_) && measured.allFinite())
    command_ = {measured, JointVector::Zero(), JointVector::Zero()};
  sample.command = command_;
  sample.state = state_;
  if (samples_.size() == kLastSamples) samples_.pop_front();
  samples_.push_back(sample);
  return samples_.back();
}

void Servo::check_arm(ServoSample& sample) {
  history_.add(state_time_, sample.measured);  // one that has come before is refused, and is there already
  if (state_ == ServoState::kIdle || state_ == ServoState::kFault) return;
  if (!sample.measured.allFinite())
    return fail(FaultCause::kBadState, "measured joint positions are not finite");
  int joint = 0;
  const double error = (sample.measured - command_.position).cwiseAbs().maxCoeff(&joint);
  if (error > options_.max_following)
    fail(FaultCause::kFollowing, "joint " + std::to_string(joint + 1) + " is " + std::to_string(error) +
                                     " rad from where it was commanded to be");
}

void Servo::take_pose(const PoseReading& reading, ServoSample& sample) {
  const std::optional<JointVector> joints = history_.at(reading.capture_time);
  std::optional<RigidTransform> expected;
  if (joints && base_T_model_) expected = base_T_camera(*joints).inverse() * *base_T_model_;
  sample.verdict = gate_.judge(reading, sample.time, joints.has_value(), expected);
  if (sample.verdict != PoseVerdict::kTaken) return;
  const RigidTransform base_T_model = base_T_camera(*joints) * reading.camera_T_model;
  ++poses_taken_;
  ++poses_since_go_;
  const double share = std::max(options_.newest_share, 1.0 / poses_taken_);
  base_T_model_ = base_T_model_ ? blended(*base_T_model_, base_T_model, share) : base_T_model;
  last_capture_ = reading.capture_time;
  if (!may_move(state_) || !goal_chosen_) return;
  RigidTransform goal_T_tool;
  see_goal(sample.measured, sample, goal_T_tool);  // where the arm is, not where it was told to be
  if (!convergence_.add(sample.tool_error)) return;
  if (state_ == ServoState::kApproaching) {
    command(ServoEvent::kStandoffReached);
    convergence_.restart();
  } else if (standoff_ == 0) {
    command(ServoEvent::kTouched);
  }
}

void Servo::check_times(const ServoSample& sample) {
  if (!may_move(state_)) return;
  if (sample.time - last_capture_ > options_.lost_timeout)
    fail(FaultCause::kPosesLost, "no usable pose for " + std::to_string(options_.lost_timeout) + " s");
  else if (sample.time - go_time_ > options_.goal_timeout)
    fail(FaultCause::kTimeout, "not at the goal after " + std::to_string(options_.goal_timeout) + " s");
}

void Servo::move(ServoSample& sample) {
  if (!goal_chosen_) start_goal();
  RigidTransform goal_T_tool;
  see_goal(sample.measured, sample, goal_T_tool);  // so that an arm that hangs below its command is corrected
  ServoCommand wanted = servo_command(goal_T_tool, options_.gain);
  if (wanted.near_half_turn)
    fail(FaultCause::kHalfTurn, "the tool is turned away from the goal by 170 degrees or more");
  const bool blind = sample.time - last_capture_ > options_.pose_timeout;
  if (wanted.near_half_turn || blind) {
    command_ = stop_motion(command_, options_.motion);
    return;
  }
  const bool axial = state_ == ServoState::kAxial;
  if (axial) follow_axis(sample, wanted.body_twist);
  // The controller believes the tool to be where the camera's calibration and the goal's source say.
  const RigidTransform flange_T_tool = told_.flange_T_camera * camera_T_tool_;
  const Twist flange_twist = carried_twist(flange_T_tool, wanted.body_twist);
  const RigidTransform flange = base_T_flange(geometry_, command_.position);
  const InverseVelocity joints = inverse_velocity(
      geometry_, command_.position, turned_twist(flange.linear(), flange_twist), options_.inverse);
  const TipLimit tip{flange_T_tool.translation(),
                     axial ? options_.approach.axial_speed : options_.approach.free_speed};
  const LimitedMotion motion = limit_motion(geometry_, command_, joints.velocity, tip, options_.motion);
  command_ = motion.next;
  sample.bound = motion.bound;
  sample.condition = joints.condition;
  sample.share = joints.share;
  sample.camera_twist =
      carried_twist(told_.flange_T_camera.inverse(),
                    turned_twist(flange.linear().transpose(),
                                 flange_jacobian(geometry_, command_.position) * command_.velocity));
  check_blocked(sample);
}

/// Moves the goal on, and the tool with it; what the law adds is for the rest of the error.
void Servo::follow_axis(const ServoSample& sample, Twist& tool_twist) {
  const double next = next_standoff(standoff_, sample.tool_error, options_.motion.cycle, options_.approach);
  tool_twist[2] += (standoff_ - next) / options_.motion.cycle;
  if (standoff_ > 0 && next == 0) convergence_.restart();  // what was counted was another goal
  standoff_ = next;
}

void Servo::check_blocked(const ServoSample& sample) {
  const bool singular = sample.share < options_.inverse.leaving_share;
  const bool at_limit =
      sample.bound == MotionBound::kJointLimit && command_.velocity.cwiseAbs().maxCoeff() < 0.01;
  if (!singular && !at_limit) {
    blocked_since_ = -1;
    return;
  }
  if (blocked_since_ < 0) blocked_since_ = sample.time;
  if (sample.time - blocked_since_ < options_.blocked_timeout) return;
  if (singular)
    fail(FaultCause::kSingularity,
         "condition number " + std::to_string(sample.condition) + ": the goal is out of reach");
  else
    fail(FaultCause::kJointLimit, "the goal cannot be reached within the joints' limits");
}

RigidTransform Servo::base_T_camera(const JointVector& position) const {
  return base_T_flange(geometry_, position) * told_.flange_T_camera;
}

void Servo::see_goal(const JointVector& position, ServoSample& sample, RigidTransform& goal_T_tool) const {
  const RigidTransform camera_T_model = base_T_camera(position).inverse() * *base_T_model_;
  const RigidTransform model_T_tool = stood_off(model_T_tool_touch_, standoff_);
  goal_T_tool = tool_T_tool_goal(camera_T_tool_, camera_T_model, model_T_tool).inverse();
  sample.goal_seen = true;
  sample.standoff = standoff_;
  sample.tool_error = goal_error(goal_T_tool);
  const RigidTransform goal_T_camera =
      camera_T_model_goal(camera_T_tool_, model_T_tool) * camera_T_model.inverse();
  sample.camera_error = goal_error(goal_T_camera);
  sample.features << goal_T_camera.translation(), rotation_vector(goal_T_camera.linear());
}

/// Chooses the turn about the axis once, at the start, so that it does not drift with the poses.
void Servo::start_goal() {
  const RigidTransform camera_T_model = base_T_camera(command_.position).inverse() * *base_T_model_;
  model_T_tool_touch_ =
      model_T_tool_goal(goal_.entry, goal_.axis, 0, camera_T_model.inverse() * camera_T_tool_);
  goal_chosen_ = true;
}

}  // namespace edgepose
