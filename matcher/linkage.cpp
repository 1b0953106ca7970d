#include "matcher/linkage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <span>

namespace edgepose {
namespace {

/// Points in the cells of a box, so small that all points of a cell are linked: what remains is which cells
/// are. No hashing, as the box is small.
class LinkedCells {
 public:
  static constexpr int kReach = 2;  // cells that a link can span

  LinkedCells(const std::vector<Eigen::Vector3f>& points, float link)
      : points_(points), link_(link), inverse_cell_(1 / (0.57f * link)) {  // 0.57 sqrt(3) < 1
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p : points) box.extend(p);
    low_ = box.min();
    size_ = ((box.max() - low_) * inverse_cell_).array().floor().cast<int>() + 1;
    first_.assign(static_cast<size_t>(size_.prod()) + 1, 0);
    for (const Eigen::Vector3f& p : points) ++first_[cell_of(p) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    members_.resize(points.size());
    for (uint32_t i = 0; i < points.size(); ++i) members_[next[cell_of(points[i])]++] = i;
    root_.resize(first_.size() - 1);
    std::iota(root_.begin(), root_.end(), 0u);
    link_all();
  }

  size_t count() const { return root_.size(); }
  /// The cell that stands for the point's cluster.
  uint32_t root_of(const Eigen::Vector3f& p) { return root(cell_of(p)); }

 private:
  void link_all() {
    uint32_t last = ~0u;
    for (const uint32_t member : members_) {  // by cells
      const uint32_t cell = cell_of(points_[member]);
      if (cell != last) link_around(cell);
      last = cell;
    }
  }
  void link_around(uint32_t here) {
    const auto rest = static_cast<int>(here);
    const Eigen::Array3i cell(rest % size_.x(), rest / size_.x() % size_.y(), rest / size_.x() / size_.y());
    const Eigen::Array3i from = (cell - kReach).max(0), to = (cell + kReach).min(size_ - 1);
    for (int z = from.z(); z <= to.z(); ++z)
      for (int y = from.y(); y <= to.y(); ++y)
        for (uint32_t there = index({from.x(), y, z}), last = index({to.x(), y, z}); there <= last; ++there)
          if (there > here && !members(there).empty() && root(here) != root(there) && touch(here, there))
            root_[std::max(root(here), root(there))] = std::min(root(here), root(there));
  }
  bool touch(uint32_t a, uint32_t b) const {
    for (const uint32_t i : members(a))
      for (const uint32_t k : members(b))
        if ((points_[i] - points_[k]).squaredNorm() < link_ * link_) return true;
    return false;
  }
  uint32_t root(uint32_t cell) {
    while (root_[cell] != cell) cell = root_[cell] = root_[root_[cell]];
    return cell;
  }
  std::span<const uint32_t> members(uint32_t cell) const {
    return std::span(members_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }
  uint32_t cell_of(const Eigen::Vector3f& p) const {
    return index(((p - low_) * inverse_cell_).array().floor().cast<int>().max(0).min(size_ - 1));
  }
  uint32_t index(const Eigen::Array3i& c) const {
    return static_cast<uint32_t>((c.z() * size_.y() + c.y()) * size_.x() + c.x());
  }

  const std::vector<Eigen::Vector3f>& points_;
  float link_, inverse_cell_;
  Eigen::Vector3f low_;
  Eigen::Array3i size_;
  std::vector<uint32_t> first_, members_;  // points by cells
  std::vector<uint32_t> root_;             // of each cell's cluster, by way of others
};

}  // namespace

std::vector<uint32_t> link_clusters(const std::vector<Eigen::Vector3f>& points, float link) {
  if (points.empty()) return {};
  LinkedCells cells(points, link);
  constexpr uint32_t kNone = ~0u;
  std::vector<uint32_t> number(cells.count(), kNone), cluster(points.size());
  uint32_t count = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    uint32_t& known = number[cells.root_of(points[i])];
    if (known == kNone) known = count++;
    cluster[i] = known;
  }
  return cluster;
}

}  // namespace edgepose
