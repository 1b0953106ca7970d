#include "models/phantom/phantom_views.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "render/depth_renderer.h"

namespace edgepose::phantom {
namespace {

using Eigen::Vector3d;

constexpr int kSide = 300;  // pixels of one view

RgbImage view_from(const Mesh& mesh, const Vector3d& direction, const Vector3d& up) {
  const Vector3d forward = -direction.normalized(), right = forward.cross(up).normalized();
  RigidTransform camera_T_model = RigidTransform::Identity();
  camera_T_model.linear() << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  const Vector3d middle(0.002, 0.025, -0.002);
  camera_T_model.translation() = Vector3d(0, 0, 0.6) - camera_T_model.linear() * middle;

  const Camera camera{1650, 1650, (kSide - 1) / 2.0, (kSide - 1) / 2.0};
  DepthRenderer renderer;
  renderer.add(mesh, camera_T_model);
  return shade_depth(renderer.render(camera, kSide, kSide).depth, camera);
}

}  // namespace

RgbImage phantom_views(const Mesh& mesh) {
  const Vector3d head(0, 0, 1), back(0, 1, 0);
  const std::pair<Vector3d, Vector3d> views[] = {{{0, 1, 0}, head},    {{0, -1, 0}, head},
                                                 {{1, 0, 0}, head},    {{-0.5, 1, 0.6}, head},
                                                 {{0, 0.01, 1}, back}, {{0.8, -0.9, 0.4}, head}};
  RgbImage all{3 * kSide, 2 * kSide, {}};
  all.rgb.resize(3 * static_cast<size_t>(all.width) * static_cast<size_t>(all.height));
  for (int i = 0; i < 6; ++i) {
    const RgbImage view = view_from(mesh, views[i].first, views[i].second);
    for (int row = 0; row < kSide; ++row) {
      const auto from = view.rgb.begin() + 3 * kSide * row;
      std::copy(from, from + 3 * kSide,
                all.rgb.begin() + 3 * ((i / 3 * kSide + row) * all.width + i % 3 * kSide));
    }
  }
  return all;
}

}  // namespace edgepose::phantom
