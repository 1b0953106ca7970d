#include "simulator/work_cell.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "arm/kinematics.h"
#include "arm/rigid_motion.h"
#include "common/error.h"
#include "files/point_spread.h"
#include "files/sound_mesh.h"
#include "simulator/cell_meshes.h"

namespace edgepose {
namespace {

using Eigen::Vector3d;

/// Found by a search: for all poses within 100 mm and 20 degrees of the standoff the condition number stays
/// below 11.5 and the joints within 2.6 rad (tests/simulator/work_cell_test.cpp).
const JointVector kNominal = (JointVector() << -0.3, 0.151, -1.979, -0.353, -1.722, 0.0).finished();

constexpr double kDrillLength = 0.30;                      // [m] from the flange to the tip
constexpr double kCameraAside = 0.12, kCameraBack = 0.24;  // [m] from the flange
constexpr double kTableGap = 0.005;                        // [m] between bone and table
constexpr double kTableHalf = 0.35, kTableThickness = 0.03;

/// Beside the flange and behind it, its optical axis through the tip of the drill; x stays in the plane of
/// drill and camera.
RigidTransform camera_on_bracket() {
  const Vector3d place(kCameraAside, 0, -kCameraBack);
  const Vector3d z = (Vector3d(0, 0, kDrillLength) - place).normalized();
  const Vector3d y = Vector3d::UnitY();
  Eigen::Matrix3d rotation;
  rotation << y.cross(z), y, z;
  return rigid_transform(rotation, place);
}

std::pair<Vector3d, Vector3d> bounds(const Mesh& mesh, const RigidTransform& pose) {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Vector3d placed = pose * vertex.cast<double>();
    low = low.cwiseMin(placed);
    high = high.cwiseMax(placed);
  }
  return {low, high};
}

}  // namespace

std::string WorkCellOptions::check() const {
  if (model.empty()) return "model: expected a mesh file, found none";
  if (plan.empty()) return "plan: expected a drill plan, found none";
  return "";
}

const DrillTarget& WorkCell::find_target(const std::string& name) const {
  const auto found = std::find_if(plan.targets.begin(), plan.targets.end(),
                                  [&](const DrillTarget& t) { return t.name == name; });
  if (found != plan.targets.end()) return *found;
  std::string known;
  for (const DrillTarget& t : plan.targets) known += (known.empty() ? "" : ", ") + t.name;
  throw InputError::at("target", "one of the plan's (" + known + ")", "'" + name + "'");
}

WorkCell make_work_cell(const WorkCellOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError(fault);
  const SoundMesh read = read_sound_mesh(options.model, options.unit);
  const DrillPlan plan = read_drill_plan(options.plan);
  const auto [low, high] = bounds(read.mesh, RigidTransform::Identity());
  check_drill_plan(plan, (low + high) / 2, largest_spread(read.mesh.vertices), options.plan.string());
  return make_work_cell(read.mesh, plan, options.target);
}

WorkCell make_work_cell(const Mesh& model, const DrillPlan& plan, const std::string& target) {
  if (model.triangles.empty()) throw InputError::at("model", "a mesh with triangles", "a cloud");
  if (plan.targets.empty()) throw InputError::at("plan", "a target", "none");
  WorkCell cell;
  cell.arm = aubo_i5();
  cell.nominal = kNominal;
  cell.flange_T_camera = camera_on_bracket();
  cell.flange_T_tool.translation().z() = kDrillLength;
  cell.model = model;
  cell.plan = plan;
  cell.target = target.empty() ? plan.targets.front().name : target;
  const DrillTarget& touched = cell.find_target(cell.target);
  cell.base_T_model = base_T_tool(cell, cell.nominal) * model_T_tool_at(touched, 0).inverse();
  cell.tool = drill_mesh(kDrillLength);

  // Azure Kinect, narrow field of view, unbinned.
  cell.camera = {504, 504, 319.5, 287.5};
  cell.width = 640, cell.height = 576;
  cell.min_depth = 0.5, cell.max_depth = 3.86;

  // z up, against the drill.
  const RigidTransform turned = rigid_transform(rotation_matrix({std::numbers::pi, 0, 0}), Vector3d::Zero());
  const RigidTransform base_T_up = base_T_tool(cell, cell.nominal) * turned;
  const auto [low, high] = bounds(model, base_T_up.inverse() * cell.base_T_model);
  const Vector3d middle = (low + high) / 2;
  cell.base_T_table = base_T_up * Eigen::Translation3d(middle.x(), middle.y(), low.z() - kTableGap);
  cell.table = box_mesh({-kTableHalf, -kTableHalf, -kTableThickness}, {kTableHalf, kTableHalf, 0});
  return cell;
}

RigidTransform base_T_tool(const WorkCell& cell, const JointVector& joints) {
  return base_T_flange(cell.arm, joints) * cell.flange_T_tool;
}

RigidTransform model_T_tool(const WorkCell& cell, const JointVector& joints) {
  return cell.base_T_model.inverse() * base_T_tool(cell, joints);
}

RigidTransform camera_T_model(const WorkCell& cell, const JointVector& joints) {
  return (base_T_flange(cell.arm, joints) * cell.flange_T_camera).inverse() * cell.base_T_model;
}

RigidTransform model_T_tool_at(const DrillTarget& target, double standoff) {
  const Vector3d z = target.axis.normalized();
  const Vector3d wanted = std::abs(z.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d x = (wanted - wanted.dot(z) * z).normalized();
  Eigen::Matrix3d rotation;
  rotation << x, z.cross(x), z;
  return rigid_transform(rotation, target.entry - standoff * z);
}

PositioningError positioning_error(const RigidTransform& model_T_tool, const DrillTarget& target) {
  const Vector3d axis = target.axis.normalized(), drill = model_T_tool.linear().col(2);
  const Vector3d off = model_T_tool.translation() - target.entry;
  PositioningError error;
  error.along = off.dot(axis);
  error.across = (off - error.along * axis).norm();
  error.translation = off.norm();
  error.angle = std::atan2(axis.cross(drill).norm(), axis.dot(drill));
  return error;
}

PositioningError positioning_error(const WorkCell& cell, const JointVector& joints,
                                   const DrillTarget& target) {
  return positioning_error(model_T_tool(cell, joints), target);
}

double clearance(const WorkCell& cell, const RigidTransform& base_T_tool) {
  const RigidTransform model_T_drill = cell.base_T_model.inverse() * base_T_tool;
  const Vector3d tip = model_T_drill.translation(), back = -model_T_drill.linear().col(2);
  const double length = cell.flange_T_tool.translation().z();
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& vertex : cell.model.vertices) {
    const Vector3d off = vertex.cast<double>() - tip;
    const double behind = std::clamp(off.dot(back), 0.0, length);
    least = std::min(least, (off - behind * back).norm() - drill_radius(behind));
  }
  constexpr double kStep = 0.01;  // [m]
  const RigidTransform table_T_tool = cell.base_T_table.inverse() * base_T_tool;
  for (double behind = 0; behind <= length; behind += kStep) {
    const double height = (table_T_tool * Vector3d(0, 0, -behind)).z();
    least = std::min(least, height - drill_radius(behind));
  }
  return least;
}

}  // namespace edgepose
