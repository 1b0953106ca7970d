#include "bench/method.h"

#include <cmath>
#include <map>
#include <tuple>

#include "matcher/surface_sampling.h"

namespace edgepose::bench {

std::vector<OrientedPoint> grid_sampled(const std::vector<OrientedPoint>& points, double cell) {
  struct Sum {
    Eigen::Vector3f position = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
    float count = 0;
  };
  std::map<std::tuple<int, int, int>, Sum> cells;
  const auto scale = static_cast<float>(1 / cell);
  for (const OrientedPoint& point : points) {
    const Eigen::Vector3i index = (point.position * scale).array().floor().cast<int>();
    Sum& sum = cells[{index.x(), index.y(), index.z()}];
    sum.position += point.position;
    sum.normal += point.normal;
    ++sum.count;
  }
  std::vector<OrientedPoint> sampled;
  for (const auto& [index, sum] : cells) {
    if (sum.normal.norm() < 1e-3f * sum.count) continue;  // opposed normals: no surface to speak of
    sampled.push_back({sum.position / sum.count, sum.normal.normalized()});
  }
  return sampled;
}

std::vector<OrientedPoint> surface_points(const Object& object, size_t count) {
  return sample_surface(object.mesh, count, 1);
}

}  // namespace edgepose::bench
