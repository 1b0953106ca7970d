#pragma once
#include <Eigen/Core>
#include <bit>
#include <cmath>

#include "matcher/model_block.h"
#include "matcher/scene_data.h"

namespace edgepose {

/// A pose in single precision, as the inner loops use it.
struct PoseF {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;

  Eigen::Vector3f operator*(const Eigen::Vector3f& p) const { return rotation * p + translation; }
};

/// The stored view from which the camera sees the model in this pose.
inline size_t view_of_pose(const Model::View& model, const PoseF& camera_T_model,
                           const Eigen::Vector3f& centre) {
  const Eigen::Vector3f camera = -(camera_T_model.rotation.transpose() * camera_T_model.translation);
  return model.nearest_view((camera - centre).normalized());
}

inline Eigen::Vector3f box_centre(const ModelHeader& h) {
  return ((Eigen::Vector3d(h.box_min.data()) + Eigen::Vector3d(h.box_max.data())) / 2).cast<float>();
}

/// Pinhole projection, rounded to the pixel.
struct PixelProjection {
  explicit PixelProjection(const Scene::Data& scene)
      : fx(static_cast<float>(scene.camera.fx)),
        fy(static_cast<float>(scene.camera.fy)),
        cx(static_cast<float>(scene.camera.cx)),
        cy(static_cast<float>(scene.camera.cy)),
        width(scene.width),
        height(scene.height) {}

  /// Index of the pixel that `p` (camera frame) falls on, or -1 outside of the image.
  int64_t pixel(const Eigen::Vector3f& p) const {
    if (!(p.z() > 1e-3f)) return -1;
    return pixel_at(fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy);
  }
  int64_t pixel_at(float u, float v) const {
    const float uf = u + 0.5f, vf = v + 0.5f;
    if (!(uf >= 0 && vf >= 0 && uf < static_cast<float>(width) && vf < static_cast<float>(height))) return -1;
    return static_cast<int64_t>(static_cast<int>(vf)) * width + static_cast<int>(uf);
  }
  Eigen::Vector2f project(const Eigen::Vector3f& p) const {
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy};
  }
  Eigen::Vector3f ray(int64_t pixel_index) const {
    const auto index = static_cast<uint32_t>(pixel_index), columns = static_cast<uint32_t>(width);
    const uint32_t column = index % columns, row = index / columns;
    const auto u = static_cast<float>(column), v = static_cast<float>(row);
    return {(u - cx) / fx, (v - cy) / fy, 1.f};
  }

  float fx, fy, cx, cy;
  int width, height;
};

/// Calls visit(index) for each of the first `limit` dense points that the view shows. The dense points are
/// in progressive order, so a smaller limit is an even subset.
template <typename Visit>
void for_visible_points(const Model::View& model, size_t view, size_t limit, const Visit& visit) {
  const auto words = model.visible_from(view);
  limit = std::min(limit, model.dense_points.size());
  for (size_t w = 0; w * 64 < limit; ++w)
    for (uint64_t bits = words[w]; bits != 0; bits &= bits - 1) {
      const size_t i = w * 64 + static_cast<size_t>(std::countr_zero(bits));
      if (i >= limit) return;
      visit(i);
    }
}

}  // namespace edgepose
