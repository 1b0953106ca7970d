#include "matcher/partner_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "matcher/point_grid.h"

namespace edgepose {
namespace {

constexpr int64_t kCellsPerReach = 2;  // smaller cells hug the ball better, larger ones make longer runs

}  // namespace

PartnerSearch::PartnerSearch(const std::vector<OrientedPoint>& points, float reach)
    : inverse_cell_(kCellsPerReach / reach) {
  std::vector<uint64_t> key(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const auto [x, y, z] = cell(points[i].position);
    key[i] = cell_key(z, y, x);  // x last: neighbours along it follow each other
  }
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key[a] < key[b]; });
  for (uint32_t i : order) {
    const OrientedPoint& p = points[i];
    keys_.push_back(key[i]);
    sorted_.x.push_back(p.position.x()), sorted_.y.push_back(p.position.y()),
        sorted_.z.push_back(p.position.z());
    sorted_.nx.push_back(p.normal.x()), sorted_.ny.push_back(p.normal.y()),
        sorted_.nz.push_back(p.normal.z());
  }
}

void PartnerSearch::runs_near(const Eigen::Vector3f& centre, std::vector<Run>& runs) const {
  runs.clear();
  const auto [x, y, z] = cell(centre);
  auto from = keys_.begin();
  for (int64_t dz = -kCellsPerReach; dz <= kCellsPerReach; ++dz)
    for (int64_t dy = -kCellsPerReach; dy <= kCellsPerReach; ++dy) {
      from = std::lower_bound(from, keys_.end(), cell_key(z + dz, y + dy, x - kCellsPerReach));
      const auto to = std::upper_bound(from, keys_.end(), cell_key(z + dz, y + dy, x + kCellsPerReach));
      if (from == to) continue;
      runs.emplace_back(static_cast<uint32_t>(from - keys_.begin()),
                        static_cast<uint32_t>(to - keys_.begin()));
      from = to;
    }
}

std::array<int64_t, 3> PartnerSearch::cell(const Eigen::Vector3f& p) const {
  const auto at = [&](float c) { return static_cast<int64_t>(std::floor(c * inverse_cell_)); };
  return {at(p.x()), at(p.y()), at(p.z())};
}

}  // namespace edgepose
