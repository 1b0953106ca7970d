#pragma once
#include <vector>

#include "matcher/pose_projection.h"

namespace edgepose {

/// The surface points that a view shows, posed and projected into the image; structure of arrays, so that
/// they are computed side by side. Points beyond count() fill the last lanes and fall on no pixel.
class PosedSurface {
 public:
  /// Takes the first `limit` dense points as far as the view shows them; nothing if it already has these.
  void take(const Model::View& model, size_t view, size_t limit);

  /// Moves them to a pose and finds the pixels that they fall on.
  void place(const PoseF& camera_T_model, const PixelProjection& projection);

  size_t count() const { return indices.size(); }
  size_t padded() const { return pixel.size(); }

  std::vector<uint32_t> indices;           ///< into Model::View::dense_points
  std::vector<float> x, y, z, nx, ny, nz;  ///< [m] camera frame; unit normals
  std::vector<float> ray_x, ray_y;         ///< of the ray through the pixel's centre, z = 1
  std::vector<int32_t> pixel;              ///< index of the pixel, -1 outside of the image

 private:
  const OrientedPoint* points_ = nullptr;  // of the model that was taken
  size_t view_ = ~size_t{0}, limit_ = 0;
  std::vector<float> model_x_, model_y_, model_z_, model_nx_, model_ny_, model_nz_;  // model frame
};

}  // namespace edgepose
