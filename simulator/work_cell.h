#pragma once
#include <filesystem>
#include <string>

#include "arm/arm_geometry.h"
#include "files/drill_plan.h"
#include "files/mesh_file.h"
#include "matcher/types.h"

/// The world of the simulator. What stands here is the truth: nobody who controls the arm may read it.
namespace edgepose {

/// What is put into the work cell.
struct WorkCellOptions {
  std::filesystem::path model;                ///< mesh of the bone
  LengthUnit unit = LengthUnit::kMillimetre;  ///< of the mesh
  std::filesystem::path plan;                 ///< drill plan for it
  std::string target;  ///< of the plan: the bone is placed so that the arm touches it in its best posture;
                       ///< empty: the first

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// An arm with a drill and a depth camera on its flange over a bone on a (tilted) table. Frames as in
/// docs/servoing.md.
struct WorkCell {
  ArmGeometry arm;
  JointVector nominal = JointVector::Zero();  ///< [rad] in which the drill touches the target
  RigidTransform flange_T_camera = RigidTransform::Identity();
  RigidTransform flange_T_tool = RigidTransform::Identity();
  RigidTransform base_T_model = RigidTransform::Identity();
  RigidTransform base_T_table =
      RigidTransform::Identity();  ///< middle of its top, z up, against the target's axis
  Mesh model;                      ///< [m] model frame
  Mesh tool;                       ///< [m] tool frame
  Mesh table;                      ///< [m] table frame
  Camera camera;
  int width = 0, height = 0;            ///< [pixels]
  double min_depth = 0, max_depth = 0;  ///< [m] that the camera measures
  DrillPlan plan;
  std::string target;  ///< name of the target that is touched in the nominal posture

  const DrillTarget& find_target(const std::string& name) const;  ///< throws InputError: none of that name
};

/// Reads model and plan. Throws InputError if they cannot be read, do not belong together, or there is no
/// such target.
WorkCell make_work_cell(const WorkCellOptions& options);
/// The same of what is in memory; `target` empty: the plan's first.
WorkCell make_work_cell(const Mesh& model, const DrillPlan& plan, const std::string& target);

/// The truth at these joint positions [rad].
RigidTransform base_T_tool(const WorkCell& cell, const JointVector& joints);
RigidTransform model_T_tool(const WorkCell& cell, const JointVector& joints);
RigidTransform camera_T_model(const WorkCell& cell, const JointVector& joints);

/// The pose of the tool `standoff` [m] before the entry of a hole, on its axis; x of the tool towards z of
/// the model as far as the axis allows.
RigidTransform model_T_tool_at(const DrillTarget& target, double standoff);

/// Where the tip is as against the entry of a hole. The turn about the drill's axis is free.
struct PositioningError {
  double along = 0;        ///< [m] past the entry, along the hole's axis; negative: before it
  double across = 0;       ///< [m] from the axis, >= 0
  double translation = 0;  ///< [m] of the tip from the entry
  double angle = 0;        ///< [rad] between the drill's axis and the hole's, 0 to pi
};
PositioningError positioning_error(const RigidTransform& model_T_tool, const DrillTarget& target);
PositioningError positioning_error(const WorkCell& cell, const JointVector& joints,
                                   const DrillTarget& target);

/// [m] of the drill's surface from the model's vertices or the table, whichever is nearer; negative: within.
/// To the spacing of the model's vertices.
double clearance(const WorkCell& cell, const RigidTransform& base_T_tool);

}  // namespace edgepose
