#pragma once
#include <optional>
#include <string>

#include "simulator/work_cell.h"

namespace edgepose {

/// Joint positions [rad] that give the flange this pose, by damped Newton steps from `near`: the solution of
/// the same posture. None if there is none within the joints' limits. To 1e-10 m and rad.
std::optional<JointVector> joints_for(const ArmGeometry& arm, const RigidTransform& base_T_flange,
                                      const JointVector& near);

/// Where an arm may start from.
struct StartOptions {
  double standoff = 0.04;        ///< [m] of the pose about which starts are drawn
  double max_distance = 0.1;     ///< [m] of the tip from there
  double max_turn = 0.34906585;  ///< [rad] of the tool: 20 degrees
  double min_clearance = 0.02;   ///< [m] of the drill from bone and table
  double joint_margin = 0.3;     ///< [rad] kept from the joints' limits
  double min_visible = 0.5;  ///< 0 to 1: of the bone's surface that faces the camera, the drill hides no more

  std::string check() const;
};

/// A random start for `target`: the tool's pose at the standoff, moved by up to max_distance and turned by up
/// to max_turn (direction, axis and amount each drawn evenly), drawn again until it keeps the clearance and
/// the camera sees enough of the bone: nobody sends an arm on its way that cannot see where. The
/// same for the same cell, target and seed. Throws InputError if an option is wrong or no start is found.
JointVector draw_start(const WorkCell& cell, const DrillTarget& target, uint64_t seed,
                       const StartOptions& options = {});

/// At the standoff itself, without a draw. Throws InputError if it is out of reach.
JointVector standoff_start(const WorkCell& cell, const DrillTarget& target, double standoff = 0.04);

}  // namespace edgepose
