/// Draws a model that comes without its mesh: each surface sample becomes a small disc; where the discs end,
/// or fall behind one another, there is an edge.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "client/cli/match_overlay.h"
#include "matcher/model_block.h"
#include "render/depth_renderer.h"

namespace edgepose {
namespace {

constexpr double kDiscRadius = 1.5;  // [dense steps] neighbouring discs overlap
constexpr float kJump = 0.035f;      // [size] a step in depth this large is an edge
constexpr float kHidden = 0.025f;    // [size] the scene this far in front hides the model
constexpr double kTint = 0.22;
constexpr double kHiddenEdge = 0.45;

void blend(RgbImage& picture, int x, int y, const Colour& colour, double opacity) {
  for (int c = 0; c < 3; ++c) {
    uint8_t& value = picture.rgb[3 * (static_cast<size_t>(y) * picture.width + x) + c];
    value = static_cast<uint8_t>(std::lround((1 - opacity) * value + opacity * colour[c]));
  }
}

/// Whether the model ends, or falls back by more than `jump`, within a pixel of (x, y).
bool on_edge(const DepthImage& model, int x, int y, float jump) {
  const float depth = model.at(x, y);
  for (int v = std::max(0, y - 1); v <= std::min(model.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(model.width - 1, x + 1); ++u) {
      if (model.at(u, v) <= 0 || model.at(u, v) > depth + jump) return true;
    }
  }
  return false;
}

}  // namespace

Mesh sample_discs(const Model& model) {
  const Model::View& view = model.view();
  const auto radius = static_cast<float>(kDiscRadius * view.header->dense_step);
  constexpr uint32_t kCorners = 6;
  Mesh mesh;
  for (const OrientedPoint& point : view.dense_points) {
    const Eigen::Vector3f across = point.normal.unitOrthogonal(), third = point.normal.cross(across);
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    for (uint32_t i = 0; i < kCorners; ++i) {
      const float turn = static_cast<float>(i) * 6.2831853f / kCorners;
      mesh.vertices.emplace_back(point.position +
                                 radius * (std::cos(turn) * across + std::sin(turn) * third));
    }
    for (uint32_t i = 1; i + 1 < kCorners; ++i) mesh.triangles.push_back({first, first + i, first + i + 1});
  }
  return mesh;
}

void draw_samples(RgbImage& picture, const SceneInput& scene, const OverlayPose& pose) {
  const int scale = picture.width / scene.image.width;
  const Camera& camera = scene.camera;
  const Camera enlarged{camera.fx * scale, camera.fy * scale, (camera.cx + 0.5) * scale - 0.5,
                        (camera.cy + 0.5) * scale - 0.5};
  DepthRenderer renderer;
  renderer.add(*pose.mesh, pose.camera_T_model);
  const DepthImage seen = renderer.render(enlarged, picture.width, picture.height).depth;
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : pose.mesh->vertices) box.extend(vertex);
  const float size = box.diagonal().norm();
  const float jump = kJump * size, slack = kHidden * size;
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      const float depth = seen.at(x, y);
      if (depth <= 0) continue;
      const float measured = scene.image.at(x / scale, y / scale);
      const bool hidden = measured > 0 && measured < depth - slack;
      if (on_edge(seen, x, y, jump)) {
        blend(picture, x, y, pose.colour, hidden ? kHiddenEdge : 1.0);
      } else if (!hidden) {
        blend(picture, x, y, pose.colour, kTint);
      }
    }
  }
}

}  // namespace edgepose
