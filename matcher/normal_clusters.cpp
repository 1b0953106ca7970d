#include "matcher/normal_clusters.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace edgepose {
namespace {

int shift_for(size_t slots) { return 64 - static_cast<int>(std::bit_width(slots - 1)); }

}  // namespace

NormalClusterGrid::NormalClusterGrid(float cell, float theta_deg, size_t expected) : inverse_cell_(1 / cell) {
  const float cosine = std::cos(theta_deg * std::numbers::pi_v<float> / 180);
  square_cosine_ = cosine * cosine;
  slots_.resize(std::bit_ceil(std::max<size_t>(512, expected) * 2));
  shift_ = shift_for(slots_.size());
  clusters_.reserve(expected + 1);
  clusters_.emplace_back();
  heads_.reserve(expected + 1);
  heads_.push_back(0);
}

/// The cluster of a cell that a point belongs to; a new one if there is none.
uint32_t NormalClusterGrid::cluster_of(uint32_t cell, uint32_t number, const Eigen::Vector3f& normal) {
  uint32_t at = heads_[cell];
  while (at != 0 && !faces_like(clusters_[at], normal)) at = clusters_[at].next;
  if (at != 0) return at;
  at = static_cast<uint32_t>(clusters_.size());
  NormalCluster& begun = clusters_.emplace_back();
  begun.next = heads_[cell];
  begun.first = number;
  return heads_[cell] = at;
}

void NormalClusterGrid::add(const PointRow& given) {
  const PointRow row = given;  // what is local need not be read anew after each sum that is stored
  NormalCluster* clusters = clusters_.data();
  uint32_t *heads = heads_.data(), last_cell = last_cell_, number = last_number_, last = last_;
  for (size_t k = 0; k < row.count; ++k) {
    const uint32_t cell = row.cell[k];
    if (cell == 0) continue;
    const Eigen::Vector3f normal(row.nx[k], row.ny[k], row.nz[k]);
    // A choice without a branch: nobody can foresee where the next cell begins, but that the cluster fits.
    const uint32_t head = heads[cell];
    uint32_t at = cell == last_cell ? last : head;
    ++number;
    if (!faces_like(clusters[at], normal)) {
      at = cluster_of(cell, number, normal);
      clusters = clusters_.data();
    }
    last_cell = cell;
    last = at;
    NormalCluster& c = clusters[at];
    c.position += Eigen::Vector3f(row.x[k], row.y[k], row.z[k]);
    c.normal += normal;
    c.weight += 1;
    c.area += row.area[k];
    c.edge_weight += row.edge[k];
  }
  last_cell_ = last_cell, last_number_ = number, last_ = last;
}

uint32_t NormalClusterGrid::cell_of(uint64_t key) {
  size_t slot = slot_of(key);
  if (slots_[slot].key == key) return slots_[slot].cell;
  if (heads_.size() * 2 > slots_.size()) grow(), slot = slot_of(key);
  slots_[slot] = {key, static_cast<uint32_t>(heads_.size())};
  heads_.push_back(0);
  return slots_[slot].cell;
}

/// Where the key is, or where it belongs.
size_t NormalClusterGrid::slot_of(uint64_t key) const {
  // The product's highest bits are the ones that all of the key takes part in.
  size_t slot = key * 0x9e3779b97f4a7c15ull >> shift_;
  while (slots_[slot].key != key && slots_[slot].key != kNoKey) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void NormalClusterGrid::grow() {
  std::vector<Slot> slots(slots_.size() * 2);
  slots.swap(slots_);
  shift_ = shift_for(slots_.size());
  for (const Slot& slot : slots)
    if (slot.key != kNoKey) slots_[slot_of(slot.key)] = slot;
}

}  // namespace edgepose
