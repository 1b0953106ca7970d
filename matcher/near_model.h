#pragma once
#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <vector>

#include "matcher/model_block.h"

namespace edgepose {

/// Tells which points (model frame) lie within a distance [m] of the model's surface: a bit for each cell of
/// a grid over the model, right to half a cell, a quarter of the distance.
class NearModel {
 public:
  NearModel(const Model::View& model, float distance);
  bool operator()(const Eigen::Vector3f& p) const;

 private:
  Eigen::Vector3f origin_;
  Eigen::Array3i size_;
  float inverse_cell_;
  std::vector<bool> near_;
};

/// The one that was asked for last, so that it is not made anew for each image (2 ms). Safe from any thread.
class NearModelCache {
 public:
  std::shared_ptr<const NearModel> get(const Model::View& model, float distance);

 private:
  std::mutex mutex_;
  float distance_ = -1;
  std::shared_ptr<const NearModel> last_;
};

}  // namespace edgepose
