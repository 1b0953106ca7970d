#pragma once
#include "matcher/types.h"

namespace edgepose {

/// A box with faces along the axes of its frame [m].
Mesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// A drill in the frame of the tool: its tip at the origin, pointing along z, `length` [m] back to the
/// flange. From the tip: a bit of 2.5 mm radius, its holder of 6 mm, the chuck, the motor.
Mesh drill_mesh(double length);

/// [m] the drill's radius `behind` [m] its tip.
double drill_radius(double behind);

}  // namespace edgepose
