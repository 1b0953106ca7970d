#include "models/phantom/sample_scenes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "models/phantom/scene_parts.h"
#include "render/depth_renderer.h"
#include "render/sensor_model.h"

namespace edgepose::phantom {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// A camera `distance` metres from `target`, `tilt` degrees from straight above towards `azimuth`.
RigidTransform camera_T_table(const Vector3d& target, double distance, double azimuth, double tilt,
                              double roll) {
  const Vector3d up(std::sin(radians(tilt)) * std::cos(radians(azimuth)),
                    std::sin(radians(tilt)) * std::sin(radians(azimuth)), std::cos(radians(tilt)));
  const Vector3d forward = -up;
  const Vector3d right = forward.cross(Vector3d(-0.1, 0.99, 0.12)).normalized(), down = forward.cross(right);
  RigidTransform result = RigidTransform::Identity();
  result.linear() << right.transpose(), down.transpose(), forward.transpose();
  result.linear() = (AngleAxisd(radians(roll), Vector3d::UnitZ()) * result.linear()).eval();
  result.translation() = Vector3d(0, 0, distance) - result.linear() * target;
  return result;
}

/// The phantom lying on its front, head towards +y, turned by small angles; its origin at (x, y, z).
RigidTransform prone(const Vector3d& origin, double turn, double lean, double pitch) {
  RigidTransform result = RigidTransform::Identity();
  result.linear() << -1, 0, 0, 0, 0, 1, 0, 1, 0;  // x to -x, y (back) to z (up), z (head) to y
  result.linear() =
      (AngleAxisd(radians(turn), Vector3d::UnitZ()) * AngleAxisd(radians(lean), Vector3d::UnitY()) *
       AngleAxisd(radians(pitch), Vector3d::UnitX()) * result.linear())
          .eval();
  result.translation() = origin;
  return result;
}

/// Any orientation, about `origin`.
RigidTransform tumbled(const Vector3d& origin, const Vector3d& axis, double degrees) {
  RigidTransform result(AngleAxisd(radians(degrees), axis.normalized()));
  result.translation() = origin - result.linear() * Vector3d(0, 0.022, 0);  // turn about its middle
  return result;
}

/// A retractor's blade that holds the tissue on one side (+1 or -1) of the opening, and its handle.
Mesh retractor(double side, double opening, double y) {
  const double x = side * (opening - 0.004), out = side * (opening + 0.02);
  return rod(
      {{x, y, 0.045}, {x + side * 0.002, y, 0.072}, {out, y + 0.004, 0.078}, {side * 0.16, y + 0.03, 0.1}},
      {0.005, 0.005, 0.004, 0.0055});
}

/// A probe with a thick handle that points at the opening.
Mesh probe(const Vector3d& tip, const Vector3d& direction) {
  const Vector3d d = direction.normalized();
  return rod({tip, tip + 0.07 * d, tip + 0.075 * d, tip + 0.17 * d, tip + 0.175 * d},
             {0.0015, 0.0025, 0.008, 0.009, 0.005});
}

struct Layout {
  RigidTransform table_T_model, camera_T_table;
  std::vector<Mesh> parts;
};

Mesh table() { return box({-0.7, -0.6, -0.03}, {0.7, 0.6, 0}); }

Layout operation(int index) {
  switch (index) {
    case 0:
      return {prone({0.004, 0.003, 0.024}, 12, 4, -3),
              camera_T_table({0, 0, 0.05}, 0.47, 200, 14, 5),
              {table(), tissue({0.048, 0.03, 0.062, 0.06, 0.003, 11})}};
    case 1:
      return {prone({0.002, -0.004, 0.024}, -8, -5, 4),
              camera_T_table({0, 0, 0.06}, 0.36, 320, 18, -10),
              {table(), tissue({0.066, 0.048, 0.037, 0.05, 0.003, 21}), retractor(1, 0.037, 0.005),
               probe({-0.006, -0.012, 0.078}, {-0.5, -0.7, 0.45})}};
    case 3:
      return {prone({-0.006, 0.002, 0.024}, 100, -6, 5),
              camera_T_table({0, 0, 0.05}, 0.45, 80, 25, 20),
              {table(), tissue({0.045, 0.035, 0.065, 0.065, 0.003, 31}),
               probe({0.05, 0.03, 0.06}, {0.8, 0.5, 0.4})}};
    case 4:
      return {prone({0.003, 0.004, 0.024}, 5, 7, -6),
              camera_T_table({0, 0, 0.06}, 0.37, 140, 22, 170),
              {table(), tissue({0.065, 0.046, 0.04, 0.052, 0.003, 41}), retractor(-1, 0.04, -0.008),
               retractor(1, 0.04, 0.012)}};
    default:
      return {prone({0.002, 0.001, 0.024}, -15, 3, 3),
              camera_T_table({0, 0.005, 0.06}, 0.36, 250, 20, 0),
              {table(), tissue({0.062, 0.045, 0.042, 0.052, 0.003, 61}), retractor(1, 0.042, 0.006),
               probe({0.008, 0.014, 0.074}, {-0.6, 0.6, 0.35})}};
  }
}

Layout clutter(int index) {
  const bool first = index == 2;
  Layout layout;
  layout.table_T_model =
      first ? tumbled({0.01, 0, 0.04}, {1, 0.4, 0.2}, 75) : tumbled({-0.01, 0.01, 0.042}, {0.2, 1, 0.5}, 130);
  layout.camera_T_table =
      first ? camera_T_table({0, 0, 0.03}, 0.4, 290, 30, 0) : camera_T_table({0, 0, 0.03}, 0.42, 30, 35, -15);
  const double s = first ? 1 : -1;
  layout.parts = {
      table(),
      box({-0.13, 0.05, 0}, {-0.06, 0.12, 0.05}),
      box({0.07, -0.1, 0}, {0.1, 0.03, 0.035}),
      rod({{-0.1 * s, -0.07, 0}, {-0.1 * s, -0.07, 0.09}}, {0.03, 0.035}),
      rod({{0.1, 0.11 * s, 0.012}, {-0.03, 0.09 * s, 0.012}}, {0.012, 0.012}),
      probe({-0.005, -0.035 * s, 0.055}, {0.7, -0.6 * s, 0.15}),
      rod({{-0.06, 0.005, 0.004}, {-0.06, -0.001, 0.012}, {-0.02, -0.07, 0.015}}, {0.004, 0.005, 0.005})};
  return layout;
}

void measure_visibility(const Mesh& phantom, const RenderedView& view, const RenderedView& alone,
                        SampleScene& scene) {
  for (size_t i = 0; i < view.object.size(); ++i) {
    scene.pixels_alone += alone.object[i] == 0;
    scene.pixels_visible += view.object[i] == 0;
  }
  double whole = 0, visible = 0;
  for (const auto& t : phantom.triangles) {
    const Vector3d a = phantom.vertices[t[0]].cast<double>(), b = phantom.vertices[t[1]].cast<double>(),
                   c = phantom.vertices[t[2]].cast<double>();
    const double area = (b - a).cross(c - a).norm() / 2;
    whole += area;
    const Vector3d middle = scene.camera_T_model * Vector3d((a + b + c) / 3);
    const auto u = std::lround(kSampleCamera.fx * middle.x() / middle.z() + kSampleCamera.cx);
    const auto v = std::lround(kSampleCamera.fy * middle.y() / middle.z() + kSampleCamera.cy);
    if (u < 0 || v < 0 || u >= kSampleWidth || v >= kSampleHeight) continue;
    const auto pixel = static_cast<size_t>(v * kSampleWidth + u);
    const double seen = static_cast<double>(view.depth.depth[pixel]);
    if (view.object[pixel] == 0 && std::abs(seen - middle.z()) < 0.003) visible += area;
  }
  scene.occlusion = 1 - visible / whole;
}

}  // namespace

SampleScene sample_scene(const Mesh& phantom, int index) {
  if (index < 0 || index >= kSampleScenes) throw std::out_of_range("sample scene: expected 0 to 6");
  const Layout layout = index % 3 == 2 ? clutter(index) : operation(index);
  SampleScene scene;
  scene.camera_T_model = layout.camera_T_table * layout.table_T_model;

  DepthRenderer renderer;
  renderer.add(phantom, scene.camera_T_model);
  const RenderedView alone = renderer.render(kSampleCamera, kSampleWidth, kSampleHeight);
  for (const Mesh& part : layout.parts) renderer.add(part, layout.camera_T_table);
  const RenderedView view = renderer.render(kSampleCamera, kSampleWidth, kSampleHeight);

  measure_visibility(phantom, view, alone, scene);
  scene.depth = apply_sensor(view.depth, kSampleCamera, SensorModel::time_of_flight(),
                             1000 + static_cast<uint64_t>(index));
  return scene;
}

}  // namespace edgepose::phantom
