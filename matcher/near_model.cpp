#include "matcher/near_model.h"

namespace edgepose {

NearModel::NearModel(const Model::View& model, float distance) {
  constexpr int kReach = 2;  // cells in the distance
  const float cell = distance / kReach;
  inverse_cell_ = 1 / cell;
  const ModelHeader& h = *model.header;
  const Eigen::Vector3f low = Eigen::Vector3d(h.box_min.data()).cast<float>(),
                        high = Eigen::Vector3d(h.box_max.data()).cast<float>();
  origin_ = low.array() - (kReach + 1) * cell;
  size_ = ((high - low) * inverse_cell_).array().ceil().cast<int>() + 2 * (kReach + 1) + 1;
  near_.assign(static_cast<size_t>(size_.prod()), false);
  for (const OrientedPoint& m : model.dense_points) {
    const Eigen::Vector3f at = (m.position - origin_) * inverse_cell_;
    const Eigen::Array3i first = (at.array().floor().cast<int>() - kReach).max(0);
    const Eigen::Array3i last = (at.array().floor().cast<int>() + kReach).min(size_ - 1);
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x) {
          const Eigen::Vector3f middle = Eigen::Array3i(x, y, z).cast<float>() + 0.5f;
          if ((middle - at).squaredNorm() < kReach * kReach)
            near_[(static_cast<size_t>(z) * size_.y() + y) * size_.x() + x] = true;
        }
  }
}

bool NearModel::operator()(const Eigen::Vector3f& p) const {
  const Eigen::Array3f at = (p - origin_) * inverse_cell_;
  if (!((at >= 0).all() && (at < size_.cast<float>()).all())) return false;
  const Eigen::Array3i c = at.cast<int>();
  return near_[(static_cast<size_t>(c.z()) * size_.y() + c.y()) * size_.x() + c.x()];
}

std::shared_ptr<const NearModel> NearModelCache::get(const Model::View& model, float distance) {
  const std::scoped_lock lock(mutex_);
  if (last_ == nullptr || distance_ != distance) {
    last_ = std::make_shared<const NearModel>(model, distance);
    distance_ = distance;
  }
  return last_;
}

std::shared_ptr<NearModelCache> make_near_model_cache() { return std::make_shared<NearModelCache>(); }

}  // namespace edgepose
