#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/loop_wire.h"
#include "controller/arm_controller.h"
#include "controller/pose_inbox.h"
#include "simulator/pose_source.h"
#include "simulator/simulated_arm.h"
#include "simulator/work_cell.h"

namespace edgepose {

/// Where poses come from in simulated time: sees the arm at these joints [rad] at `capture_utime` [us] since
/// 1970, and says what is to be sent once it has been worked out.
using PoseFeed =
    std::function<std::vector<OutgoingMessage>(const JointVector& joints, int64_t capture_utime)>;

struct VirtualCellOptions {
  double pose_period = 0.033;  ///< [s] between frames; fewer frames cost less time and delay the arrival
  double pose_latency = 0.1;   ///< [s] from capture until the answer comes
  ServoOptions servo;
  MasterOptions master;
  SimulatedArmOptions arm;  ///< where it starts, and what is wrong with its drives
  std::optional<SecretKey> key = std::nullopt;
};

/// Controller and simulated arm on one wire, with the code and the bytes of the real ones, in simulated time:
/// the controller's cycle every 5 ms, the drives every millisecond. The same calls give the same bits. One
/// thread.
class VirtualCell {
 public:
  /// `cell` must live longer; `model`: as the feed's messages name it.
  VirtualCell(const WorkCell& cell, const std::string& model, const ToldCalibration& told,
              const RigidTransform& camera_T_tool, PoseFeed feed, const VirtualCellOptions& options);

  /// One cycle of 5 ms.
  void cycle();
  void run(double seconds);
  /// Until `holds`, looked at after each cycle; false if it did not within so many seconds.
  bool run_until(const std::function<bool()>& holds, double seconds);

  /// Posts it and goes on until it is answered: empty if obeyed, else why not. At most 5 s.
  std::string request(const ArmRequest& request);
  /// As the command: looks the hole up, follows it, goes. Empty, or why not.
  std::string go(const std::string& target);
  void stop() { controller.stop(now_ns); }
  /// Arms and goes, and lets the arm move for so long. Empty, or what went wrong.
  std::string set_out(const std::string& target, double seconds);

  bool is_moving() const { return arm.velocity().cwiseAbs().maxCoeff() > 1e-4; }
  PositioningError error(const DrillTarget& target) const;

  const WorkCell& cell;
  LoopWire wire;
  LoopWire::Port& controller_port;
  LoopWire::Port& arm_port;
  int64_t now_ns = 1'000'000'000;                            ///< steady clock
  int64_t wall_minus_steady_ns = 1'700'000'000'000'000'000;  ///< step it, and the wall clock steps
  SimulatedArm arm;
  ArmController controller;
  PoseInbox poses;
  PoseFeed feed;
  bool controller_lives = true;           ///< false: as after kill -9, or stopped
  std::function<void()> each_ms = [] {};  ///< after each step of the drives
  ControlSample sample;                   ///< of the last cycle

 private:
  struct Delivery {
    int64_t due_ns;
    OutgoingMessage message;
  };
  void look();
  void deliver();

  const VirtualCellOptions options_;
  std::deque<Delivery> deliveries_;
  int64_t next_look_ns_;
};

}  // namespace edgepose
