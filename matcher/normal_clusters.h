#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "matcher/point_grid.h"
#include "matcher/sampled_point.h"

namespace edgepose {

/// Points of one cell with like normals, summed up.
struct NormalCluster {
  Eigen::Vector3f position = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();  // weighted sums
  float weight = 0, area = 0, edge_weight = 0;
  uint32_t next = 0;   // in the same cell, 0 = none
  uint32_t first = 0;  // number of the point that began it

  WeightedPoint mean() const {
    return {{{position / weight, normal.normalized()}, area, edge_weight > 0.3f * weight}, weight};
  }
};

/// Points side by side, as structure of arrays.
struct PointRow {
  const uint32_t* cell;  // number of the cell of a NormalClusterGrid; 0: leave it out
  const float *x, *y, *z, *nx, *ny, *nz, *area;
  const float* edge;  // 1 on an edge, else 0
  size_t count;
};

/// Merges points that share a cell of a grid and whose normals differ by less than theta.
class NormalClusterGrid {
 public:
  static constexpr uint64_t kNoKey = ~uint64_t{0};  // of no cell

  /// `expected`: about so many clusters; it grows as needed.
  NormalClusterGrid(float cell, float theta_deg, size_t expected);

  float inverse_cell() const { return inverse_cell_; }

  /// Number of the cell of cell_key(), from 1 on.
  uint32_t cell_of(uint64_t key);

  void add(const SampledPoint& p, float weight) {
    add(cell_of(cell_key(p.surface.position, inverse_cell_)), last_number_ + 1, p, weight);
  }
  /// `number`: the point's place in the sequence of all, rising. Points may be left out that are in other
  /// cells: what becomes of this one does not depend on them.
  void add(uint32_t cell, uint32_t number, const SampledPoint& p, float weight) {
    // Neighbouring points mostly share a cluster.
    uint32_t at = cell == last_cell_ && number == last_number_ + 1 ? last_ : heads_[cell];
    if (!faces_like(clusters_[at], p.surface.normal)) at = cluster_of(cell, number, p.surface.normal);
    last_cell_ = cell;
    last_number_ = number;
    last_ = at;
    NormalCluster& c = clusters_[at];
    c.position += weight * p.surface.position;
    c.normal += weight * p.surface.normal;
    c.weight += weight;
    c.area += p.area;
    c.edge_weight += p.edge ? weight : 0;
  }

  /// The same for points that follow each other, each with a weight of 1.
  void add(const PointRow& row);

  size_t size() const { return clusters_.size() - 1; }
  /// In the order of their first points.
  const NormalCluster& operator[](size_t i) const { return clusters_[i + 1]; }

 private:
  struct Slot {
    uint64_t key = kNoKey;
    uint32_t cell = 0;
  };

  bool faces_like(const NormalCluster& c, const Eigen::Vector3f& normal) const {
    const float along = c.normal.dot(normal);
    return along > 0 && along * along >= square_cosine_ * c.normal.squaredNorm();
  }
  uint32_t cluster_of(uint32_t cell, uint32_t number, const Eigen::Vector3f& normal);
  size_t slot_of(uint64_t key) const;
  void grow();

  float inverse_cell_, square_cosine_;
  std::vector<NormalCluster> clusters_;  // the first is none
  std::vector<uint32_t> heads_;          // of each cell the cluster that was begun last; the first is none
  std::vector<Slot> slots_;              // at most half are taken
  int shift_ = 0;                        // from a hash to the number of a slot
  uint32_t last_cell_ = 0;               // of the point added last,
  uint32_t last_number_ = 0;             // its number
  uint32_t last_ = 0;                    // and its cluster
};

}  // namespace edgepose
