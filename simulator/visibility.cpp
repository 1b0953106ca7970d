#include "simulator/visibility.h"

#include "simulator/cell_meshes.h"

namespace edgepose {
namespace {

constexpr size_t kEachVertex = 7;  // of these one is looked at
constexpr double kAlong = 0.002;   // [m] between two points of a line of sight: less than the bit is thick

bool is_in_image(const WorkCell& cell, const Eigen::Vector3d& camera_point) {
  if (camera_point.z() < cell.min_depth || camera_point.z() > cell.max_depth) return false;
  const double u = cell.camera.fx * camera_point.x() / camera_point.z() + cell.camera.cx,
               v = cell.camera.fy * camera_point.y() / camera_point.z() + cell.camera.cy;
  return u >= 0 && u <= cell.width - 1 && v >= 0 && v <= cell.height - 1;
}

/// Whether the drill stands between two points of the tool's frame.
bool is_hidden(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double length) {
  const Eigen::Vector3d way = to - from;
  const auto steps = static_cast<int>(way.norm() / kAlong);
  for (int i = 1; i < steps; ++i) {
    const Eigen::Vector3d at = from + way * i / steps;
    const double behind = -at.z();
    if (behind >= 0 && behind <= length && at.head<2>().norm() < drill_radius(behind)) return true;
  }
  return false;
}

}  // namespace

double visible_share(const WorkCell& cell, const JointVector& joints) {
  const RigidTransform camera_T = camera_T_model(cell, joints);
  const RigidTransform tool_T_camera = cell.flange_T_tool.inverse() * cell.flange_T_camera;
  const double length = cell.flange_T_tool.translation().norm();
  int facing = 0, seen = 0;
  for (size_t i = 0; i < cell.model.vertices.size(); i += kEachVertex) {
    const Eigen::Vector3d point = camera_T * cell.model.vertices[i].cast<double>();
    const Eigen::Vector3d normal = camera_T.linear() * cell.model.normals[i].cast<double>();
    if (normal.dot(point) >= 0) continue;
    ++facing;
    seen +=
        is_in_image(cell, point) && !is_hidden(tool_T_camera.translation(), tool_T_camera * point, length);
  }
  return facing == 0 ? 0 : static_cast<double>(seen) / facing;
}

}  // namespace edgepose
