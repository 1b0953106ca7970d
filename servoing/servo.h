#pragma once
#include <deque>
#include <optional>
#include <string>

#include "arm/inverse_velocity.h"
#include "arm/motion_limiter.h"
#include "servoing/approach.h"
#include "servoing/chain.h"
#include "servoing/joint_history.h"
#include "servoing/pose_gate.h"
#include "servoing/servo_state.h"

namespace edgepose {

struct ServoOptions {
  MotionOptions motion;
  InverseVelocityOptions inverse;
  ApproachOptions approach;
  AdaptiveGain gain;
  PoseGateOptions gate;
  JointHistoryOptions history;
  double newest_share = 0.2;  ///< (0, 1] of a new pose in the estimate of where the model is; less is
                              ///< smoother, later. The first poses are averaged
  int confirming_poses = 3;   ///< that must agree before the arm moves
  double pose_timeout =
      0.6;  ///< [s] without a new pose (since its capture) after which the arm slows to rest ...
  double lost_timeout = 5;  ///< [s] ... and after which it is a fault
  double blocked_timeout =
      3;  ///< [s] held back by a singularity or a joint's limit, after which it is a fault
  double goal_timeout = 120;    ///< [s] from go to touch
  double max_following = 0.05;  ///< [rad] between commanded and measured joints, the drives' lag included

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// What to come to: a hole, in the frame of the model.
struct ServoGoal {
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit; the way the drill moves
};

/// One cycle, as it is published and kept for the report of a fault.
struct ServoSample {
  double time = 0;  ///< [s]
  ServoState state = ServoState::kIdle;
  JointState command;                          ///< to be sent in this cycle
  JointVector measured = JointVector::Zero();  ///< [rad]
  bool goal_seen = false;                      ///< the errors and the standoff mean something
  GoalError tool_error, camera_error;          ///< to the goal that is moved to now, as believed
  /// What position-based servoing of the camera drives to zero: goal_T_camera as (t [m], theta u [rad]).
  Twist features = Twist::Zero();
  double standoff = 0;                     ///< [m] of that goal before the entry
  Twist camera_twist = Twist::Zero();      ///< commanded, of the camera in its own frame: the paper's plot
  double condition = 0;                    ///< of the Jacobian
  double share = 1;                        ///< of the twist that a singularity leaves
  MotionBound bound = MotionBound::kNone;  ///< what held the motion back
  std::optional<PoseVerdict> verdict;      ///< of this cycle's pose
};

/// The servo loop, one call a cycle: state, poses and time come in, the next joint command comes out. Holds
/// no clock, no thread, no socket; the same calls give the same bits. Not safe for use by several threads at
/// once.
class Servo {
 public:
  static constexpr size_t kLastSamples = 50;

  /// `camera_T_tool`: from calibration, exact or taught (servoing/chain.h). Throws InputError if an option or
  /// a transform is none.
  Servo(const ArmGeometry& arm, const ToldCalibration& told, const RigidTransform& camera_T_tool,
        const ServoOptions& options);

  /// Commands. Empty if obeyed, else why not, in words. `measured` [rad]: the arm at rest, from where it
  /// starts.
  std::string arm(const JointVector& measured);
  std::string go(const ServoGoal& goal, double now);
  std::string stop();
  std::string reset();

  /// What bus and drives find wrong. The first cause is kept until reset. `drives_off`: they have stopped by
  /// themselves, so the command stays where it is; else the arm comes to rest by the controlled stop.
  void fail(FaultCause cause, const std::string& detail, bool drives_off = false);

  /// One cycle. `now` [s] on the steady clock; `measured` [rad]: the joints `state_age` [s] ago; `reading`: a
  /// pose that has come since the last. In every state: what to command. Where nothing may move, it comes to
  /// rest by the controlled stop.
  const ServoSample& cycle(double now, const JointVector& measured, const std::optional<PoseReading>& reading,
                           double state_age = 0);

  ServoState state() const { return state_; }
  FaultCause fault() const { return fault_; }
  const std::string& fault_detail() const { return fault_detail_; }
  /// Up to 50; while in kFault those that led to it.
  const std::deque<ServoSample>& last_samples() const {
    return state_ == ServoState::kFault ? fault_samples_ : samples_;
  }
  const PoseGate& gate() const { return gate_; }

 private:
  std::string command(ServoEvent event);
  void take_pose(const PoseReading& reading, ServoSample& sample);
  void check_arm(ServoSample& sample);
  void check_times(const ServoSample& sample);
  void follow_axis(const ServoSample& sample, Twist& tool_twist);
  void check_blocked(const ServoSample& sample);
  void move(ServoSample& sample);
  RigidTransform base_T_camera(const JointVector& position) const;
  void see_goal(const JointVector& position, ServoSample& sample, RigidTransform& goal_T_tool) const;
  void start_goal();

  ArmGeometry geometry_;
  ToldCalibration told_;
  RigidTransform camera_T_tool_;
  ServoOptions options_;

  ServoState state_ = ServoState::kIdle;
  FaultCause fault_ = FaultCause::kNone;
  std::string fault_detail_;
  bool drives_off_ = false;
  JointState command_;
  JointHistory history_;
  PoseGate gate_;
  Convergence convergence_;
  std::deque<ServoSample> samples_, fault_samples_;

  std::optional<RigidTransform> base_T_model_;  ///< the estimate, from the poses taken since arm
  int poses_taken_ = 0;
  int poses_since_go_ = 0;
  double state_time_ = 0;  ///< [s] of the measured joints
  double last_capture_ = 0;
  ServoGoal goal_;
  RigidTransform model_T_tool_touch_ = RigidTransform::Identity();  ///< the goal at the entry, turn chosen
  bool goal_chosen_ = false;
  double standoff_ = 0;
  double go_time_ = 0;
  double blocked_since_ = -1;
};

}  // namespace edgepose
