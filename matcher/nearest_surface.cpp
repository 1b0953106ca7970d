#include "matcher/nearest_surface.h"

#include <Eigen/Geometry>
#include <numeric>

namespace edgepose {

NearestSurface::NearestSurface(const std::vector<OrientedPoint>& surface, size_t count, float reach)
    : reach_(reach), points_(count) {
  Eigen::AlignedBox3f box;
  for (size_t i = 0; i < count; ++i) box.extend(surface[i].position);
  // One empty cell all around, so that the neighbours of a cell need no check.
  corner_ = box.min().array() - 1.5f * reach;
  cells_ = cell_of(box.max()).array() + 2;
  std::vector<int> cell_of_point(count);
  first_.assign(static_cast<size_t>(cells_.prod()) + 1, 0);
  for (size_t i = 0; i < count; ++i) {
    cell_of_point[i] = index(cell_of(surface[i].position));
    ++first_[cell_of_point[i] + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (size_t i = 0; i < count; ++i) points_[next[cell_of_point[i]]++] = surface[i];
}

Eigen::Vector3i NearestSurface::cell_of(const Eigen::Vector3f& p) const {
  return ((p - corner_) / reach_).array().floor().cast<int>();
}

const OrientedPoint* NearestSurface::find(const Eigen::Vector3f& position,
                                          const Eigen::Vector3f& normal) const {
  const Eigen::Vector3i c = cell_of(position);
  if ((c.array() < 1).any() || (c.array() >= cells_.array() - 1).any()) return nullptr;
  const OrientedPoint* best = nullptr;
  float best_squared = reach_ * reach_;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y) {
      const int row = index({c.x(), c.y() + y, c.z() + z});
      for (uint32_t i = first_[row - 1]; i < first_[row + 2]; ++i) {
        const float squared = (points_[i].position - position).squaredNorm();
        if (squared < best_squared && points_[i].normal.dot(normal) > 0.5f)
          best_squared = squared, best = &points_[i];
      }
    }
  return best;
}

}  // namespace edgepose
