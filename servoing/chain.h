#pragma once
#include "arm/types.h"

/// The chain of transforms of the paper, Sec. "Transformation relationship analysis", in its order. The
/// paper's T_a^b is b_T_a here: T_e0^b is `base_T_flange`, T_c^e `flange_T_camera`, T_t^e `flange_T_tool`,
/// T_s^c `camera_T_model`, T_thope^s `model_T_tool_goal`, T_thope^t `tool_T_tool_goal`.
namespace edgepose {

/// What the controller is told of the arm's equipment. Both come from calibration and are wrong by its
/// errors.
struct ToldCalibration {
  RigidTransform flange_T_camera = RigidTransform::Identity();  ///< hand-eye
  RigidTransform flange_T_tool = RigidTransform::Identity();    ///< tip of the drill, z forward along it
};

/// Where the tool stands in the camera's frame: all that a goal needs to know of the equipment, since both
/// are fixed to the flange. There are three ways to it:
///   from the calibrations  camera_T_tool(told): their errors stay in the goal, whatever the loop does
///   exact                  camera_T_tool(camera_T_model_goal, model_T_tool_goal): the pose in which the
///   camera is
///                          to see the model is given
///   taught                 teach() (servoing/teaching.h): learned with the tool at known places of the model
RigidTransform camera_T_tool(const ToldCalibration& told);
RigidTransform camera_T_tool(const RigidTransform& camera_T_model_goal,
                             const RigidTransform& model_T_tool_goal);

/// The pose in which the camera sees the model when the tool is at its goal.
RigidTransform camera_T_model_goal(const RigidTransform& camera_T_tool,
                                   const RigidTransform& model_T_tool_goal);

/// Paper Eq. (1): the goal in the frame of the tool. T_thope^t = T_e^t T_c^e T_s^c T_thope^s.
RigidTransform tool_T_tool_goal(const RigidTransform& camera_T_tool, const RigidTransform& camera_T_model,
                                const RigidTransform& model_T_tool_goal);

/// Paper Eq. (2): the goal in the frame of the arm's base. T_thope^b = T_e0^b T_t^e T_thope^t.
RigidTransform base_T_tool_goal(const RigidTransform& base_T_flange, const RigidTransform& flange_T_tool,
                                const RigidTransform& tool_T_tool_goal);

/// The tool's pose at a hole, in the model's frame: its tip `standoff` [m] before the entry, its z along the
/// axis (unit; the way the drill moves). A drill may turn about its axis, so of all such poses this is the
/// one with the least rotation from `model_T_tool_now`; where the tool points the opposite way, any.
RigidTransform model_T_tool_goal(const Eigen::Vector3d& entry, const Eigen::Vector3d& axis, double standoff,
                                 const RigidTransform& model_T_tool_now);

}  // namespace edgepose
