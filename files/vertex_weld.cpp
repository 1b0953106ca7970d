#include "files/vertex_weld.h"

#include <bit>

namespace edgepose {
namespace {

uint64_t hash(const Eigen::Vector3f& vertex) {
  const uint64_t low = std::bit_cast<uint32_t>(vertex.x()) | uint64_t{std::bit_cast<uint32_t>(vertex.y())}
                                                                 << 32;
  uint64_t h = low * 0x9E3779B97F4A7C15u + std::bit_cast<uint32_t>(vertex.z());
  h = (h ^ (h >> 31)) * 0xBF58476D1CE4E5B9u;
  return h ^ (h >> 29);
}

bool same_bits(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  // Bits, not values: NaN must find itself, or a slot would never be found again.
  const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
  return bits(a.x()) == bits(b.x()) && bits(a.y()) == bits(b.y()) && bits(a.z()) == bits(b.z());
}

}  // namespace

uint32_t VertexWeld::add(const Eigen::Vector3f& vertex) {
  if (slots_.size() <= 2 * vertices_.size()) grow();
  const Eigen::Vector3f key = vertex.array() + 0.0f;  // -0 becomes 0
  const size_t slot = slot_of(key);
  if (slots_[slot] == 0) {
    vertices_.push_back(key);
    slots_[slot] = static_cast<uint32_t>(vertices_.size());
  }
  return slots_[slot] - 1;
}

void VertexWeld::grow() {
  slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), 0);
  for (size_t i = 0; i < vertices_.size(); ++i) slots_[slot_of(vertices_[i])] = static_cast<uint32_t>(i + 1);
}

size_t VertexWeld::slot_of(const Eigen::Vector3f& vertex) const {
  const size_t mask = slots_.size() - 1;
  size_t slot = hash(vertex) & mask;
  while (slots_[slot] != 0 && !same_bits(vertices_[slots_[slot] - 1], vertex)) slot = (slot + 1) & mask;
  return slot;
}

}  // namespace edgepose
