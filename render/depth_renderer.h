#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// What a noise-free depth camera sees.
struct RenderedView {
  DepthImage depth;             ///< metres along the optical axis; 0 where no ray hits
  std::vector<int32_t> object;  ///< per pixel: index that DepthRenderer::add() returned, -1 = nothing
};

/// Renders depth images of meshes by casting one ray through the centre of each pixel (Embree).
/// Both sides of a triangle are seen. Not safe for concurrent use of one instance.
class DepthRenderer {
 public:
  DepthRenderer();
  ~DepthRenderer();
  DepthRenderer(DepthRenderer&&) noexcept;
  DepthRenderer& operator=(DepthRenderer&&) noexcept;

  /// Adds a mesh (metres, model frame) and returns its index: 0, 1, 2... The mesh is copied.
  /// Throws std::invalid_argument if it has no triangles, a vertex that is not finite, or a triangle that
  /// names a vertex that is not there, or if the pose is not finite.
  size_t add(const Mesh& mesh, const RigidTransform& camera_T_model = RigidTransform::Identity());

  /// Moves a mesh that was added. Throws std::out_of_range or std::invalid_argument.
  void set_pose(size_t object, const RigidTransform& camera_T_model);

  /// Depth and object index of the nearest surface in each pixel. The result does not depend on `threads`
  /// (0 = all cores); where two objects coincide exactly, either's index may be given.
  /// `scene_T_camera`: where the camera stands among the meshes, whose poses are then scene_T_model; moving
  /// it is cheaper than moving them. Throws std::invalid_argument if the camera is unsound or a side is not
  /// in [1, 16384].
  RenderedView render(const Camera& camera, int width, int height, int threads = 0,
                      const RigidTransform& scene_T_camera = RigidTransform::Identity());

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace edgepose
