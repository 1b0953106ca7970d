#pragma once
#include "simulator/work_cell.h"

namespace edgepose {

/// Of the model's surface that faces the camera at these joint positions [rad], the share that lies in the
/// image and in the camera's range and that the drill does not hide, 0 to 1. To the spacing of the model's
/// vertices; what the model hides of itself counts as seen.
double visible_share(const WorkCell& cell, const JointVector& joints);

}  // namespace edgepose
