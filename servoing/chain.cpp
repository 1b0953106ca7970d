#include "servoing/chain.h"

#include <Eigen/Geometry>

#include "arm/rigid_motion.h"

namespace edgepose {

RigidTransform camera_T_tool(const ToldCalibration& told) {
  return told.flange_T_camera.inverse() * told.flange_T_tool;
}

RigidTransform camera_T_tool(const RigidTransform& camera_T_model_goal,
                             const RigidTransform& model_T_tool_goal) {
  return camera_T_model_goal * model_T_tool_goal;
}

RigidTransform camera_T_model_goal(const RigidTransform& camera_T_tool,
                                   const RigidTransform& model_T_tool_goal) {
  return camera_T_tool * model_T_tool_goal.inverse();
}

RigidTransform tool_T_tool_goal(const RigidTransform& camera_T_tool, const RigidTransform& camera_T_model,
                                const RigidTransform& model_T_tool_goal) {
  return camera_T_tool.inverse() * camera_T_model * model_T_tool_goal;
}

RigidTransform base_T_tool_goal(const RigidTransform& base_T_flange, const RigidTransform& flange_T_tool,
                                const RigidTransform& tool_T_tool_goal) {
  return base_T_flange * flange_T_tool * tool_T_tool_goal;
}

RigidTransform model_T_tool_goal(const Eigen::Vector3d& entry, const Eigen::Vector3d& axis, double standoff,
                                 const RigidTransform& model_T_tool_now) {
  const Eigen::Matrix3d& now = model_T_tool_now.linear();
  // The shortest turn that brings z onto the axis has no part about the axis itself.
  const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(now.col(2), axis).toRotationMatrix();
  return rigid_transform(turn * now, entry - standoff * axis);
}

}  // namespace edgepose
