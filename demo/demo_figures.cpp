// The plots of the report.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "arm/kinematics.h"
#include "demo/demo_report.h"

namespace edgepose {
namespace {

constexpr double kToMillimetres = 1e3, kToDegrees = 180 / std::numbers::pi;

Plot curves(const std::string& title, const std::string& y_label) {
  Plot plot;
  plot.title = title;
  plot.x_label = "s since it set out";
  plot.y_label = y_label;
  plot.y_any = true;
  return plot;
}

/// Three of the six values of each point of the controller's, as three curves.
using Six = std::array<double, 6> ControlPoint::*;
void add_three(Plot& plot, const RunTrack& track, Six values, size_t from, double factor,
               const std::string& prefix) {
  for (size_t i = 0; i < 3; ++i) {
    Series series;
    series.name = prefix + "xyz"[i];
    for (const ControlPoint& point : track.control) {
      if (!point.goal_seen) continue;
      series.x.push_back(point.time);
      series.y.push_back(factor * (point.*values)[from + i]);
    }
    plot.series.push_back(std::move(series));
  }
}

Figure pair_of(const std::string& file, const std::string& title, Plot upper, Plot lower) {
  Figure figure{.file = file, .title = title, .panels = {}, .columns = 1, .width = 960, .height = 760};
  figure.panels = {std::move(upper), std::move(lower)};
  return figure;
}

Figure features(const RunTrack& track) {
  Plot t = curves("t of goal_T_camera", "mm"), turn = curves("theta u of goal_T_camera", "degrees");
  add_three(t, track, &ControlPoint::features, 0, kToMillimetres, "t ");
  add_three(turn, track, &ControlPoint::features, 3, kToDegrees, "theta u ");
  return pair_of("feature_errors", "Feature errors, as the controller sees them", std::move(t),
                 std::move(turn));
}

Figure velocities(const RunTrack& track) {
  Plot v = curves("velocity of the camera in its own frame", "mm/s"),
       w = curves("angular velocity", "degrees/s");
  add_three(v, track, &ControlPoint::velocity, 0, kToMillimetres, "v ");
  add_three(w, track, &ControlPoint::velocity, 3, kToDegrees, "omega ");
  return pair_of("camera_velocities", "Commanded velocities of the camera", std::move(v), std::move(w));
}

Figure errors(const RunTrack& track) {
  Plot tip = curves("tip of the drill from the entry of the hole", "mm"),
       axis = curves("axis of the drill from that of the hole", "degrees");
  Series distance{"distance", {}, {}}, across{"of it, across the axis", {}, {}}, angle{"", {}, {}};
  for (const TruthPoint& point : track.truth) {
    for (Series* series : {&distance, &across, &angle}) series->x.push_back(point.time);
    distance.y.push_back(kToMillimetres * point.distance());
    across.y.push_back(kToMillimetres * point.across);
    angle.y.push_back(kToDegrees * point.angle);
  }
  tip.series = {std::move(distance), std::move(across)};
  axis.series = {std::move(angle)};
  tip.log_y = axis.log_y = true;
  return pair_of("true_errors", "True errors, by the record of the simulator", std::move(tip),
                 std::move(axis));
}

/// The path of what is fixed to the flange, as seen along an axis of the base; it ends at `goal`, if given.
Plot view(const DemoRun& run, const std::string& what, const RigidTransform& flange_T_what, int horizontal,
          const std::optional<Eigen::Vector3d>& goal) {
  Plot plot;
  plot.title = what + (horizontal == 0 ? ", seen along y" : ", seen along x");
  plot.x_label = std::string(1, "xyz"[horizontal]) + " of the base, mm";
  plot.y_label = "z of the base, mm";
  plot.to_scale = plot.y_any = true;
  Series path{"path", {}, {}}, start{"start", {}, {}}, end{goal ? "hole" : "end", {}, {}};
  const auto add = [&](Series& series, const Eigen::Vector3d& at) {
    series.x.push_back(kToMillimetres * at[horizontal]);
    series.y.push_back(kToMillimetres * at.z());
  };
  for (const TruthPoint& point : run.track.truth)
    add(path, (base_T_flange(run.cell.arm, point.joints) * flange_T_what).translation());
  for (Series* mark : {&start, &end}) mark->marks = true;
  start.x = {path.x.front()}, start.y = {path.y.front()};
  end.x = {path.x.back()}, end.y = {path.y.back()};
  if (goal) end.x.clear(), end.y.clear(), add(end, *goal);
  plot.series = {std::move(path), std::move(start), std::move(end)};
  return plot;
}

Figure paths(const DemoRun& run) {
  const Eigen::Vector3d hole = run.cell.base_T_model * run.cell.find_target(run.cell.target).entry;
  Figure figure{.file = "camera_path",
                .title = "True paths of the camera and of the tip of the drill",
                .panels = {},
                .columns = 2,
                .width = 960,
                .height = 960};
  for (const int horizontal : {0, 1})
    figure.panels.push_back(view(run, "camera", run.cell.flange_T_camera, horizontal, std::nullopt));
  for (const int horizontal : {0, 1})
    figure.panels.push_back(view(run, "tip of the drill", run.cell.flange_T_tool, horizontal, hole));
  return figure;
}

}  // namespace

std::vector<Figure> demo_figures(const DemoRun& run) {
  return {paths(run), features(run.track), velocities(run.track), errors(run.track)};
}

}  // namespace edgepose
