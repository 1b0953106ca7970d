// The tables of the report.
#include <cmath>
#include <numbers>

#include "arm/rigid_motion.h"
#include "demo/demo_report.h"
#include "evaluation/table.h"

namespace edgepose {
namespace {

constexpr double kTableStep = 2;  // [s]
constexpr double kMillimetres = 1e3, kDegrees = 180 / std::numbers::pi;

void add_step(Table& table, const RunTrack& track, double time) {
  const TruthPoint& truth = track.truth_at(time);
  const ControlPoint& control = track.control_at(time);
  const auto believed = [&](double value) { return control.goal_seen ? fixed(value, 2) : "-"; };
  table.add({fixed(truth.time, 1), control.state, fixed(kMillimetres * truth.distance(), 2),
             fixed(kMillimetres * truth.along, 2), fixed(kMillimetres * truth.across, 2),
             fixed(kDegrees * truth.angle, 2), believed(kMillimetres * control.standoff),
             believed(kMillimetres * control.tool_error), believed(kDegrees * control.tool_angle)});
}

std::string signed_text(double value, int decimals, const std::string& unit) {
  return (value < 0 ? "" : "+") + fixed(value, decimals) + " " + unit;
}

std::string vector_text(const Eigen::Vector3d& v, double factor, int decimals, const std::string& unit) {
  return signed_text(factor * v.x(), decimals, "") + signed_text(factor * v.y(), decimals, "") +
         signed_text(factor * v.z(), decimals, unit);
}

}  // namespace

std::string verdict(const DemoRun& run) {
  const TruthPoint& end = run.track.truth.back();
  const std::string where = "tip " + fixed(kMillimetres * end.distance(), 2) + " mm from the entry of " +
                            run.cell.target + " (" + fixed(kMillimetres * end.along, 2) + " along, " +
                            fixed(kMillimetres * end.across, 2) + " across), axis " +
                            fixed(kDegrees * end.angle, 2) + " degrees off, by the simulator's truth";
  if (run.converged()) return "converged after " + fixed(run.track.converged(), 1) + " s; " + where;
  return "NOT converged (" + run.state + (run.fault.empty() ? "" : ": " + harmless_text(run.fault)) + "); " +
         where;
}

std::string steps_table(const RunTrack& track) {
  Table table({"s", "state", "true tip mm", "along mm", "across mm", "axis deg", "goal before entry mm",
               "controller's own mm", "own deg"});
  for (double time = 0; time < track.end() - 0.1 * kTableStep; time += kTableStep)
    add_step(table, track, time);
  add_step(table, track, track.end());
  return table.markdown();
}

std::string told_table(const WorkCell& cell, const ToldEquipment& told) {
  const Camera& camera = told.camera;
  const auto pixels = [](double value) { return signed_text(value, 2, "pixels"); };
  Table table({"told less true", "translation", "rotation vector"});
  table.add({"fx, fy", pixels(camera.fx - cell.camera.fx), pixels(camera.fy - cell.camera.fy)});
  table.add({"cx, cy", pixels(camera.cx - cell.camera.cx), pixels(camera.cy - cell.camera.cy)});
  const auto add = [&](const std::string& name, const RigidTransform& to, const RigidTransform& from) {
    const Eigen::Vector3d turn = rotation_vector(to.linear()) - rotation_vector(from.linear());
    table.add({name, vector_text(to.translation() - from.translation(), kMillimetres, 2, "mm"),
               vector_text(turn, kDegrees, 2, "degrees")});
  };
  add("flange_T_camera (hand-eye)", told.flange_T_camera, cell.flange_T_camera);
  add("flange_T_tool", told.flange_T_tool, cell.flange_T_tool);
  return table.markdown();
}

}  // namespace edgepose
