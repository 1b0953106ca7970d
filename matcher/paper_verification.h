#pragma once
#include <vector>

#include "matcher/match.h"
#include "matcher/near_model.h"
#include "matcher/point_grid.h"
#include "matcher/pose_projection.h"

namespace edgepose {

/// The edge points of a scene, thinned to one in each cell of a grid; camera frame, metres.
class SceneEdges {
 public:
  SceneEdges(const Scene::Data& scene, float cell, float max_pixel_size);
  /// Only those in a box, which spares to look at the rest of the image; in front of the camera.
  SceneEdges(const Scene::Data& scene, float cell, float max_pixel_size, const Eigen::AlignedBox3f& within);
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  std::vector<Eigen::Vector3f> points_;
};

/// Number of scene edge points near the posed model: the quick look of Sec. 4.3.4.
float matching_edges(const SceneEdges& edges, const Model::View& model, const NearModel& near_model,
                     const PoseF& camera_T_model);

/// The region of interest of a pose: the axis-aligned box of the posed model's, its extents times `scale`;
/// camera frame, metres.
Eigen::AlignedBox3f region_of_interest(const Model::View& model, const PoseF& camera_T_model, float scale);

/// S = N_matching / N_ROI (Eq. 2): edge points in the region of interest, without clusters of edges that lie
/// far from the pose's centre, and how many of them are close to the posed model.
float edge_score(const SceneEdges& edges, const Model::View& model, const NearModel& near_model,
                 const PoseF& camera_T_model, const PaperOptions& options);

/// Share of the model's points that lie near the scene (Papazov and Burschka 2010).
float surface_overlap(const Scene::Data& scene, const Model::View& model, const PoseF& camera_T_model,
                      float distance);

/// Index of the pose that the paper's verification chooses among `poses` (sorted by votes, strongest first):
/// two classes by V_max / 2, N of each looked at in detail, early exit at 0.7 and 0.6 (Sec. 4.3.4).
/// `detailed`: how many poses were scored with Eq. 2.
size_t verify_like_the_paper(const SceneEdges& edges, const Model::View& model,
                             const std::vector<PoseF>& poses, const std::vector<float>& votes,
                             const PaperOptions& options, int threads, size_t* detailed = nullptr);

}  // namespace edgepose
