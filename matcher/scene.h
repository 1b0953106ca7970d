#pragma once
#include <memory>
#include <string>

#include "matcher/types.h"

namespace edgepose {

/// What is done once per depth image, for all models together.
struct SceneOptions {
  float min_depth = 0.05f;  ///< [m] nearer measurements are ignored
  float max_depth = 10.0f;  ///< [m] farther ones too
  int threads = 0;          ///< 0 = all cores; the result does not depend on it

  std::string check() const;
};

/// A preprocessed depth image: points, normals, edges by kind (paper Fig. 2 f-g). Shared by all models that
/// are looked for; what depends on a model's size is sampled in match(), and kept for models of like size as
/// long as the scene lives. Immutable but for that, safe from any thread.
class Scene {
 public:
  struct Data;  // matcher/scene_data.h
  const Data& data() const { return *data_; }
  double preprocessing_seconds() const;  ///< wall time

  explicit Scene(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const Data> data_;
};

/// Throws std::invalid_argument if the image is empty, has no measurement in range, or the camera is unsound.
Scene prepare_scene(const DepthImage& image, const Camera& camera, const SceneOptions& options = {});

/// An unorganised cloud as seen from `viewpoint`: a virtual depth image, its camera, and where that stands.
/// Everything after it is the same for clouds and depth images.
struct ProjectedCloud {
  DepthImage image;
  Camera camera;
  RigidTransform cloud_T_camera;
};
/// `points` in metres. The optical axis points to the median of the cloud; the resolution follows from its
/// density. Throws std::invalid_argument if fewer than 100 finite points remain.
ProjectedCloud project_cloud(const std::vector<Eigen::Vector3f>& points,
                             const Eigen::Vector3f& viewpoint = Eigen::Vector3f::Zero());

}  // namespace edgepose
