#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "simulator/work_cell.h"

namespace edgepose {

/// How wrong the controller is told to be: standard deviations, the paper's by default.
struct ToldNoise {
  double focal_px = 5;     ///< [pixels] of fx and of fy
  double centre_px = 1;    ///< [pixels] of cx and of cy
  double hand_eye = 0.01;  ///< [rad] and [m] of each component of rotation vector and translation ...
  double tool = 0.01;      ///< ... likewise

  static ToldNoise none() { return {0, 0, 0, 0}; }
  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// What the controller is told of its equipment.
struct ToldEquipment {
  Camera camera;
  RigidTransform flange_T_camera = RigidTransform::Identity();
  RigidTransform flange_T_tool = RigidTransform::Identity();
};

/// The truth, perturbed. Each part has its own draws: the same for the same seed, whatever the noise of the
/// others. Throws InputError if the noise is out of range.
ToldEquipment draw_told(const WorkCell& cell, const ToldNoise& noise, uint64_t seed);

/// Writes hand-eye.json, tool.json (docs/servoing.md) and camera.json (BOP's) into `folder`, all or none.
/// `made`: UTC, "2026-11-23T09:30:00Z". Residuals are 0 and `samples` 3: nothing was measured, which
/// `method` says. Throws InputError if they cannot be written.
void write_told(const std::filesystem::path& folder, const ToldEquipment& told, const std::string& made);

}  // namespace edgepose
