#pragma once
#include "matcher/normal_equations.h"
#include "matcher/posed_surface.h"

namespace edgepose {

struct IcpOptions {
  size_t max_points = 400;  ///< dense points used; time is proportional
  int iterations = 8;
  float max_distance = 0.01f;   ///< [m] correspondences farther apart are left out at first ...
  float min_distance = 0.003f;  ///< [m] ... and at the end
  float min_normal_cosine = 0.5f;
  bool outline = true;             ///< pull the outline to the scene's depth jumps
  int outline_stride = 1;          ///< from one point of the outline that pulls to the next
  float surface_sigma = 0.001f;    ///< [m] standard deviation of a surface correspondence
  float outline_sigma_pixels = 1;  ///< [pixels] of an outline correspondence
};

struct IcpResult {
  PoseF camera_T_model;
  /// Sum of J^T J / sigma^2 at the end, for a twist (rotation, translation) about the model's centre, camera
  /// axes.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  float surface_sigma = 1;  ///< [m] the sigma of surface correspondences in `information`
  int correspondences = 0;
  float rms = 0;  ///< [m] of the surface correspondences along the normals
};

/// What refining and judging one pose after the other works on, so that nothing is allocated for each. For
/// one model and one thread.
struct PoseWorkspace {
  PosedSurface surface;
  std::vector<float> depth, nx, ny, nz;  ///< of the scene at the points' pixels
  std::vector<float> counted;
  ResidualRows rows;
};

/// Refines a pose against the depth image (paper Sec. 4.3.4, last step; Chen and Medioni 1992): point to
/// plane with projective correspondences, the trust region shrinking from max_distance to min_distance.
IcpResult refine_pose(const Scene::Data& scene, const Model::View& model, const PoseF& start,
                      const IcpOptions& options, PoseWorkspace& work);

}  // namespace edgepose
