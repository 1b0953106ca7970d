#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "simulator/work_cell.h"

namespace edgepose {

/// How the controller of the demonstration knows its goal (docs/servoing.md).
enum class DemoGoal : uint8_t {
  kTaught,        ///< taught at five other places of the model
  kCalibrations,  ///< from the hand-eye and tool calibrations, as told
  kExact,         ///< the true place of the tool before the camera
};

/// What edgepose-servo demo runs.
struct DemoOptions {
  WorkCellOptions cell;                            ///< model and plan both empty: the phantom
  std::filesystem::path output = "edgepose-demo";  ///< folder for the report
  uint64_t seed = 1;                               ///< of start, noise of what is told, noise of the camera
  bool noise = true;                               ///< what is told is as wrong as in the paper; false: true
  DemoGoal goal = DemoGoal::kTaught;
  int taught_poses = 30;      ///< of each taught place; 30 take about 3 s
  double seconds = 120;       ///< [s] the arm has, from go on
  double frame_rate = 10;     ///< [Hz] of depth frames; a higher one costs processor time
  double start_seconds = 60;  ///< [s] each program and each command may take until it answers

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// The folder with phantom.ply and drill_plan.json: where they are installed beside the programs, or in the
/// sources that these were built in; relative to this executable. Empty: neither.
std::filesystem::path phantom_folder();

/// The folder of this executable. Throws InputError if the system does not tell.
std::filesystem::path program_folder();

}  // namespace edgepose
