#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "fuzz/input_check.h"
#include "matcher/model_block.h"

namespace {

using namespace edgepose;

/// 64-byte aligned, as a mapped file is, and as long as the model lives.
struct Block {
  explicit Block(size_t size)
      : words((size + 63) / 64), bytes(reinterpret_cast<std::byte*>(words.data()), size) {}
  struct alignas(64) Word {
    std::byte bytes[64];
  };
  std::vector<Word> words;
  std::span<std::byte> bytes;
};

/// As in matcher/model_block.cpp; LLVMFuzzerInitialize stops if they differ.
uint64_t checksum(std::span<const std::byte> bytes) {
  uint64_t hash = 0xcbf29ce484222325;
  for (size_t i = 0; i + 8 <= bytes.size(); i += 8) {
    if (i == offsetof(ModelHeader, checksum)) continue;
    uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    hash = (hash ^ word) * 0x100000001b3;
    hash ^= hash >> 29;
  }
  return hash;
}

/// Makes magic, version, size and checksum right, so that the checks behind it are reached.
void seal(std::span<std::byte> bytes) {
  if (bytes.size() < sizeof(ModelHeader)) return;
  const uint64_t size = bytes.size();
  std::memcpy(bytes.data(), kModelMagic.data(), kModelMagic.size());
  std::memcpy(bytes.data() + offsetof(ModelHeader, version), &kModelVersion, sizeof(kModelVersion));
  std::memcpy(bytes.data() + offsetof(ModelHeader, size), &size, sizeof(size));
  const uint64_t sum = checksum(bytes);
  std::memcpy(bytes.data() + offsetof(ModelHeader, checksum), &sum, sizeof(sum));
}

/// Touches everything that a matcher may touch: inside the block, finite, and what it claims to be.
void use(const Model& model) {
  const Model::View& view = model.view();
  must_hold(std::isfinite(model.diameter()) && model.centre().allFinite());
  for (const char c : model.name()) must_hold(static_cast<unsigned char>(c) >= ' ');
  const Symmetries symmetries = model.symmetries();
  for (const RigidTransform& symmetry : symmetries.discrete)
    must_hold(symmetry.matrix().allFinite() && symmetry.linear().determinant() > 0.9);
  for (const SymmetryAxis& axis : symmetries.continuous)
    must_hold(axis.point.allFinite() && std::abs(axis.direction.norm() - 1) < 0.01);
  size_t visible = 0;
  for (size_t i = 0; i < view.view_directions.size(); ++i) {
    must_hold(std::abs(view.view_directions[i].norm() - 1) < 0.01f);
    for (const uint64_t word : view.visible_from(i)) visible += word & 1;
    for (const ContourPoint& point : view.contour_from(i))
      must_hold(point.position.allFinite() && point.outwards.allFinite());
  }
  must_hold(visible <= view.visible.size());
  must_hold(view.nearest_view(Eigen::Vector3f::UnitX()) < view.view_directions.size());
  for (size_t bucket = 0; bucket + 1 < view.offsets.size(); ++bucket)
    for (uint32_t i = view.offsets[bucket]; i < view.offsets[bucket + 1]; ++i)
      must_hold(view.points[view.entries[i].reference].position.allFinite());
  for (const OrientedPoint& point : view.dense_points) must_hold(point.normal.allFinite());
}

void load(const std::shared_ptr<const Block>& block) {
  try {
    use(Model::from_block(block->bytes, block));
  } catch (const std::invalid_argument& error) {
    for (const char c : std::string_view(error.what())) must_hold(c >= ' ');
  }
}

/// A sound model, as small as can be: it is copied thousands of times a second.
const Model& small_model() {
  static const Model model = [] {
    ModelParts parts;
    ModelHeader& header = parts.header;
    header.diameter = 0.1;
    header.sampling_step = 0.02, header.dense_step = 0.01, header.distance_step = 0.05;
    header.distance_bins = 2, header.angle_bins = 3;
    header.normal_bin_first = 0, header.normal_bin_last = 2;
    header.box_min = {0, 0, 0}, header.box_max = {0.06, 0.04, 0.03};
    for (int i = 0; i < 4; ++i)
      parts.points.push_back({{0.02f * static_cast<float>(i), 0.01f, 0}, Eigen::Vector3f::UnitZ()});
    parts.dense_points = parts.points;
    parts.support_normals.assign(4, Eigen::Vector3f::UnitZ());
    const size_t buckets = 2 * 3 * 3 * 3;
    for (size_t i = 0; i <= buckets; ++i)
      parts.offsets.push_back(static_cast<uint32_t>(std::min<size_t>(i, 3)));
    parts.entries = {{0, 100}, {3, 65535}, {1, 0}};
    parts.view_directions = {Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitZ()};
    parts.visible = {5, 15};
    parts.contour_offsets = {0, 1, 2};
    parts.contours = {{{0, 0, 0.01f}, Eigen::Vector3f::UnitY()}, {{0.02f, 0, 0}, Eigen::Vector3f::UnitX()}};
    parts.discrete = {-1, 0, 0, 0.06, 0, -1, 0, 0.04, 0, 0, 1, 0, 0, 0, 0, 1};
    parts.continuous = {0, 0, 0, 0, 0, 1};
    parts.name = "box";
    return make_model(parts);
  }();
  return model;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const auto good = small_model().block();
  Block copy(good.size());
  std::memcpy(copy.bytes.data(), good.data(), good.size());
  seal(copy.bytes);
  must_hold(std::memcmp(copy.bytes.data(), good.data(), good.size()) == 0);
  return 0;
}

/// The first byte chooses: 'r' the rest is a file; 's' the same with size and checksum put right; 'p' the
/// rest are changes to a sound model, with the checksum put right: each 4 bytes of place, 1 of length and 1
/// to 8 new bytes.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const uint8_t kind = data[0];
  ++data, --size;
  if (kind == 'r' || kind == 's') {
    const auto block = std::make_shared<Block>(size);
    if (size > 0) std::memcpy(block->bytes.data(), data, size);
    if (kind == 's') seal(block->bytes);
    load(block);
    return 0;
  }
  if (kind != 'p') return 0;
  const auto good = small_model().block();
  const auto block = std::make_shared<Block>(good.size());
  std::memcpy(block->bytes.data(), good.data(), good.size());
  while (size >= 5) {
    uint32_t at;
    std::memcpy(&at, data, 4);
    // Half of the changes go to the header, where a bit decides most.
    at = at & 1 ? (at >> 1) % sizeof(ModelHeader) : (at >> 1) % static_cast<uint32_t>(good.size());
    const size_t count = std::min<size_t>({size_t{1} + data[4] % 8, size - 5, good.size() - at});
    std::memcpy(block->bytes.data() + at, data + 5, count);
    data += 5 + count, size -= 5 + count;
  }
  seal(block->bytes);
  load(block);
  return 0;
}
