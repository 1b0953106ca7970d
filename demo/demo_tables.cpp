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

std::string signed_text(double value) { return (value < 0 ? "" : "+") + fixed(value, 2); }

std::string vector_text(const Eigen::Vector3d& v) {
  return signed_text(v.x()) + ", " + signed_text(v.y()) + ", " + signed_text(v.z());
}

}  // namespace

std::string verdict(const DemoRun& run) {
  const TruthPoint& end = run.track.truth.back();
  const std::string where = "tip " + fixed(kMillimetres * end.distance(), 2) + " mm from the entry of " +
                            run.cell.target + " (" + fixed(kMillimetres * end.along, 2) + " along, " +
                            fixed(kMillimetres * end.across, 2) + " across), axis " +
                            fixed(kDegrees * end.angle, 2) + " degrees off, by the simulator's truth";
  const std::string again =
      run.faults.empty() ? "" : ", set going again after " + std::to_string(run.faults.size()) + " fault(s)";
  if (run.converged())
    return "converged after " + fixed(run.track.converged(), 1) + " s" + again + "; " + where;
  return "NOT converged (" + run.state + (run.fault.empty() ? "" : ": " + harmless_text(run.fault)) + "); " +
         where;
}

std::string steps_table(const RunTrack& track) {
  Table table({"s", "state", "true tip mm", "along mm", "across mm", "axis deg", "goal before entry mm",
               "controller's own mm", "own deg"});
  for (double time = 0; time < track.seen_last() - 0.1 * kTableStep; time += kTableStep)
    add_step(table, track, time);
  add_step(table, track, track.seen_last());
  add_step(table, track, track.end());
  return table.markdown();
}

std::string told_table(const WorkCell& cell, const ToldEquipment& told) {
  const Camera &camera = told.camera, &truth = cell.camera;
  Table table({"told less true", ""});
  table.add({"fx, fy, pixels", signed_text(camera.fx - truth.fx) + ", " + signed_text(camera.fy - truth.fy)});
  table.add({"cx, cy, pixels", signed_text(camera.cx - truth.cx) + ", " + signed_text(camera.cy - truth.cy)});
  const auto add = [&](const std::string& name, const RigidTransform& to, const RigidTransform& from) {
    const Eigen::Vector3d turn = rotation_vector(to.linear()) - rotation_vector(from.linear());
    table.add(
        {name + ": translation, mm", vector_text(kMillimetres * (to.translation() - from.translation()))});
    table.add({name + ": rotation vector, degrees", vector_text(kDegrees * turn)});
  };
  add("hand-eye (flange_T_camera)", told.flange_T_camera, cell.flange_T_camera);
  add("tool (flange_T_tool)", told.flange_T_tool, cell.flange_T_tool);
  return table.markdown();
}

}  // namespace edgepose
