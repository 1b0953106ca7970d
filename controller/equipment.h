#pragma once
#include <string>

#include "controller/controller_options.h"
#include "servoing/chain.h"

namespace edgepose {

/// What the calibration files say.
struct Equipment {
  ToldCalibration told;
  RigidTransform camera_T_tool = RigidTransform::Identity();  ///< of the goal: taught, else from `told`
  bool is_taught = false;
};

/// Reads them. Throws InputError that names file and member; also if the taught one is of another model.
Equipment read_equipment(const ControllerOptions& options);

}  // namespace edgepose
