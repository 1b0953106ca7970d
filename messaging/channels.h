#pragma once

/// The channels of proto_lcm/README.md.
namespace edgepose::channels {

inline constexpr const char* kDepth = "EDGEPOSE_DEPTH";
inline constexpr const char* kCloud = "EDGEPOSE_CLOUD";
inline constexpr const char* kPoses = "EDGEPOSE_POSES";
inline constexpr const char* kDrillTargets = "EDGEPOSE_DRILL_TARGETS";
inline constexpr const char* kStatus = "EDGEPOSE_STATUS";
inline constexpr const char* kArmState = "EDGEPOSE_ARM_STATE";

}  // namespace edgepose::channels
