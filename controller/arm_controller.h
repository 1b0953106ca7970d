#pragma once
#include <optional>
#include <string>

#include "canopen/master.h"
#include "servoing/servo.h"

namespace edgepose {

enum class ArmCommand : uint8_t {
  kArm,    ///< sets up and enables the drives, then allows go
  kGo,     ///< to a hole
  kReset,  ///< forgets a stop, an arrival or a fault; the drives are set up anew after a fault
  kHomed,  ///< somebody has made sure that the drives that have booted know their position
};

struct ArmRequest {
  ArmCommand command = ArmCommand::kArm;
  ServoGoal goal;  ///< of kGo
};

/// What a cycle was like; plain data, to be handed to other threads.
struct ControlSample {
  int64_t time_ns = 0;  ///< steady clock
  ServoSample servo;
  MasterPhase phase = MasterPhase::kIdle;
  FaultCause fault = FaultCause::kNone;
  PerAxis<uint16_t> statusword{};
  uint64_t poses_taken = 0, poses_refused = 0;  ///< since the start
};

/// The servo loop and the master of the drives as one: poses and time in, frames on the bus out. Called every
/// 5 ms; no thread, no clock, no waiting, so that it runs in simulated time as it does in real. One thread.
///
/// Whatever is found wrong on either side stops the other: a fault of bus or drives is one of the loop, and
/// on a fault of the loop the arm comes to rest by its controlled stop, or by the drives' quick stop where
/// the arm does not do what it is told, and loses its power once it is at rest.
class ArmController {
 public:
  /// `bus` must live longer. Throws InputError or std::invalid_argument that names a bad option.
  ArmController(CanBus& bus, const ArmGeometry& arm, const ToldCalibration& told,
                const RigidTransform& camera_T_tool, const ServoOptions& servo, const MasterOptions& master);

  /// One cycle.
  const ControlSample& cycle(int64_t now_ns, const std::optional<PoseReading>& reading);

  /// Takes a request, to be worked on in the next cycles; false while another is. The answer comes from
  /// take_answer(): empty if obeyed, else why not.
  bool request(const ArmRequest& request);
  std::optional<std::string> take_answer();
  /// At once, whatever else goes on: the controlled stop.
  void stop(int64_t now_ns);
  /// For the end of the program: an arm that has stopped by a fault loses its power, too, once it is at rest.
  void release() { master_.release(); }

  /// As far as it is known: the joints have moved within the last 0.1 s, or a fault left them unmeasured.
  bool is_moving(int64_t now_ns) const;

  ServoState state() const { return servo_.state(); }
  bool at_rest() const { return edgepose::at_rest(sample_.servo.command); }
  /// "": no fault; else one line.
  std::string fault_text() const;
  const Servo& servo() const { return servo_; }
  const Master& master() const { return master_; }

 private:
  void work_on_request(int64_t now_ns);
  void answer(const std::string& text);
  void continue_arming(int64_t now_ns);
  void reset(int64_t now_ns);
  void take_faults();
  void see_joints(int64_t now_ns);
  void take_power_off(int64_t now_ns);
  JointVector measured() const;

  Servo servo_;
  Master master_;
  ControlSample sample_;
  std::optional<ArmRequest> request_;
  bool arming_ = false;
  bool drives_fault_told_ = false;
  int64_t fault_ns_ = 0;                     ///< when bus or drives were found wrong
  int64_t last_motion_ns_ = 0;               ///< when the measured joints last moved
  int64_t last_sync_ns_ = 0, state_ns_ = 0;  ///< of the last SYNC; of the one that the joints answer
  JointVector last_measured_ = JointVector::Zero();
  bool joints_known_ = false;  ///< the drives have said where they are since they were set up
  std::optional<std::string> answer_;
};

/// The master's options for an arm: limits and cycle are the arm's and the loop's.
MasterOptions master_options_for(const ArmGeometry& arm, const ServoOptions& servo, MasterOptions options);

}  // namespace edgepose
