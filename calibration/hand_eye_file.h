#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "arm/arm_geometry.h"
#include "calibration/hand_eye.h"

namespace edgepose {

/// What a camera on a flange is farther away than never: a mistake of units.
inline constexpr double kMaxOnFlange = 1.0;  // [m]

/// Samples taken for a hand-eye calibration (JSON; docs/servoing.md). A sample has "joints_rad" or
/// "base_T_flange", and "camera_T_target". Throws InputError that names file and member.
std::vector<HandEyeSample> parse_hand_eye_samples(std::string_view text, const std::string& name,
                                                  const ArmGeometry& arm);
std::vector<HandEyeSample> read_hand_eye_samples(const std::filesystem::path& path, const ArmGeometry& arm);

/// The calibration as it is kept: dated, with its residuals. `made`: UTC, 2026-11-23T09:30:00Z.
struct HandEyeFile {
  std::string made, method;
  RigidTransform flange_T_camera = RigidTransform::Identity();
  int samples = 0;
  HandEyeResidual rms, worst;
};
HandEyeFile parse_hand_eye(std::string_view text, const std::string& name);
HandEyeFile read_hand_eye(const std::filesystem::path& path);
std::string format_hand_eye(const HandEyeFile& file);
void write_hand_eye(const std::filesystem::path& path, const HandEyeFile& file);

/// Where the drill's tip is on the flange, measured by whatever means.
struct ToolFile {
  std::string made, name;
  RigidTransform flange_T_tool = RigidTransform::Identity();
};
ToolFile parse_tool(std::string_view text, const std::string& name);
ToolFile read_tool(const std::filesystem::path& path);
std::string format_tool(const ToolFile& file);

}  // namespace edgepose
