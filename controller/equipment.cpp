#include "controller/equipment.h"

#include "calibration/hand_eye_file.h"
#include "calibration/teach_file.h"
#include "common/error.h"

namespace edgepose {

Equipment read_equipment(const ControllerOptions& options) {
  Equipment equipment;
  equipment.told.flange_T_camera = read_hand_eye(options.hand_eye).flange_T_camera;
  equipment.told.flange_T_tool = read_tool(options.tool).flange_T_tool;
  equipment.camera_T_tool = camera_T_tool(equipment.told);
  if (options.taught.empty()) return equipment;
  const TaughtFile taught = read_taught(options.taught);
  if (taught.model != options.model)
    throw InputError::at(options.taught, "a tool that was taught on model '" + options.model + "'",
                         "one taught on '" + taught.model + "'", "teach it on this model: edgepose teach");
  equipment.camera_T_tool = taught.taught.camera_T_tool;
  equipment.is_taught = true;
  return equipment;
}

}  // namespace edgepose
