#include "matcher/model_block.h"

#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace edgepose {
namespace {

constexpr size_t kAlignment = 64;

/// FNV-1a over 8-byte words (the block's size is a multiple of 64), except the one that holds the checksum.
uint64_t checksum(std::span<const std::byte> block) {
  static_assert(offsetof(ModelHeader, checksum) % 8 == 0);
  uint64_t hash = 0xcbf29ce484222325;
  for (size_t i = 0; i + 8 <= block.size(); i += 8) {
    if (i == offsetof(ModelHeader, checksum)) continue;
    uint64_t word;
    std::memcpy(&word, block.data() + i, 8);
    hash = (hash ^ word) * 0x100000001b3;
    hash ^= hash >> 29;
  }
  return hash;
}

[[noreturn]] void refuse(const std::string& expected, const std::string& found) {
  throw std::invalid_argument("expected " + expected + ", found " + found);
}

template <typename T>
std::span<const T> section(std::span<const std::byte> block, const ModelHeader& header, Section which) {
  const auto& extent = header.sections[static_cast<size_t>(which)];
  const uint64_t room = extent.offset <= block.size() ? block.size() - extent.offset : 0;
  if (extent.offset > block.size() || extent.offset % kAlignment != 0 || extent.count > room / sizeof(T))
    refuse("section " + std::to_string(static_cast<int>(which)) + " inside the file",
           "one that ends beyond it");
  return {reinterpret_cast<const T*>(block.data() + extent.offset), static_cast<size_t>(extent.count)};
}

template <typename T>
void require_ascending(std::span<const T> offsets, size_t expected_size, size_t last, const char* name) {
  bool sound = offsets.size() == expected_size && offsets.front() == 0 && offsets.back() == last;
  for (size_t i = 1; sound && i < offsets.size(); ++i) sound = offsets[i - 1] <= offsets[i];
  if (!sound) refuse(std::string("ascending ") + name, "others");
}

bool is_unit(const Eigen::Vector3f& v) { return std::abs(v.squaredNorm() - 1) < 0.01f; }

bool sound(std::span<const OrientedPoint> points, double limit) {
  for (const auto& p : points)
    if (!(p.position.squaredNorm() <= limit * limit) || !is_unit(p.normal)) return false;
  return true;
}

void check_header(const ModelHeader& h, size_t size) {
  if (h.magic != kModelMagic) refuse("a trained model (magic \"edgepose\")", "another kind of file");
  if (h.version != kModelVersion)
    refuse("model file version " + std::to_string(kModelVersion),
           "version " + std::to_string(h.version) + "; train the model again with this edgepose");
  if (h.size != size)
    refuse(std::to_string(h.size) + " bytes, as the header says", std::to_string(size) + " (cut short?)");
}

void check_values(const ModelHeader& h) {
  const auto in = [](double x, double low, double high) { return x >= low && x <= high; };
  if (!in(h.diameter, 1e-4, 1e3) || !in(h.sampling_step, 1e-6, 1e3) || !in(h.dense_step, 1e-6, 1e3) ||
      !in(h.distance_step, 1e-6, 1e3))
    refuse("plausible lengths in the header", "a length out of range");
  if (h.distance_bins < 1 || h.distance_bins > 1000 || h.angle_bins < 1 || h.angle_bins > 360 ||
      h.normal_bin_first > h.normal_bin_last || h.normal_bin_last >= h.angle_bins)
    refuse("plausible table dimensions in the header", "dimensions out of range");
  for (int i = 0; i < 3; ++i)
    if (!in(h.box_min[i], -1e4, 1e4) || !in(h.box_max[i], h.box_min[i], 1e4))
      refuse("a plausible bounding box in the header", "values out of range");
}

void check_symmetries(const Model::View& v) {
  for (size_t i = 0; i < v.discrete.size(); i += 16) {
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(v.discrete.data() + i);
    const Eigen::Matrix3d r = m.topLeftCorner<3, 3>();
    // Whether the largest of several is NaN when one of them is, Eigen leaves open.
    if (!m.allFinite() || !(m.rightCols<1>().cwiseAbs().maxCoeff() <= 1e4) || !r.isUnitary(1e-3) ||
        !(r.determinant() > 0) || m.row(3) != Eigen::RowVector4d::UnitW())
      refuse("rigid motions as symmetries", "others");
  }
  for (size_t i = 0; i < v.continuous.size(); i += 6) {
    const Eigen::Map<const Eigen::Vector3d> point(v.continuous.data() + i), direction(point.data() + 3);
    if (!(point.norm() <= 1e4) || !(std::abs(direction.norm() - 1) < 1e-3))
      refuse("axes with a unit direction as symmetries", "others");
  }
}

void check_contents(const Model::View& v) {
  const ModelHeader& h = *v.header;
  const size_t buckets = static_cast<size_t>(h.distance_bins) * h.angle_bins * h.angle_bins * h.angle_bins;
  if (v.points.empty() || v.points.size() > 65535)
    refuse("1 to 65535 points", std::to_string(v.points.size()));
  if (v.dense_points.empty() || v.view_directions.empty()) refuse("dense points and views", "none");
  require_ascending(v.offsets, buckets + 1, v.entries.size(), "bucket offsets");
  require_ascending(v.contour_offsets, v.view_directions.size() + 1, v.contours.size(), "contour offsets");
  if (v.visible.size() != v.words_per_view() * v.view_directions.size())
    refuse("a visibility bit for each dense point and view", "another number");
  for (const auto& e : v.entries)
    if (e.reference >= v.points.size()) refuse("pairs of known points", "a point index out of range");
  if (!sound(v.points, 1e4) || !sound(v.dense_points, 1e4))
    refuse("finite points with unit normals", "others");
  if (v.support_normals.size() != v.dense_points.size())
    refuse("a support normal for each dense point", "another number");
  for (const auto& n : v.support_normals)
    if (!is_unit(n)) refuse("unit support normals", "others");
  for (const auto& direction : v.view_directions)
    if (!is_unit(direction)) refuse("unit view directions", "others");
  for (const auto& c : v.contours)
    if (!(c.position.squaredNorm() <= 1e8f) || !is_unit(c.outwards)) refuse("finite outlines", "others");
  if (v.discrete.size() % 16 != 0 || v.continuous.size() % 6 != 0)
    refuse("whole symmetries", "a part of one");
  check_symmetries(v);
  // It goes to terminals and logs.
  const bool printable = std::none_of(v.name.begin(), v.name.end(), is_control);
  if (v.name.size() > kMaxModelName || !printable)
    refuse("a name of at most 255 bytes without control characters", "another");
}

}  // namespace

Model Model::from_block(std::span<const std::byte> block, std::shared_ptr<const void> owner) {
  if (block.size() < sizeof(ModelHeader))
    refuse("at least " + std::to_string(sizeof(ModelHeader)) + " bytes of a trained model",
           std::to_string(block.size()));
  if (reinterpret_cast<uintptr_t>(block.data()) % alignof(ModelHeader) != 0)
    refuse("an aligned block", "another");
  auto view = std::make_shared<View>();
  const auto* header = reinterpret_cast<const ModelHeader*>(block.data());
  check_header(*header, block.size());
  if (checksum(block) != header->checksum) refuse("a matching checksum", "another: the file is damaged");
  check_values(*header);

  view->header = header;
  view->points = section<OrientedPoint>(block, *header, Section::kPoints);
  view->offsets = section<uint32_t>(block, *header, Section::kOffsets);
  view->entries = section<PairEntry>(block, *header, Section::kEntries);
  view->dense_points = section<OrientedPoint>(block, *header, Section::kDensePoints);
  view->support_normals = section<Eigen::Vector3f>(block, *header, Section::kSupportNormals);
  view->view_directions = section<Eigen::Vector3f>(block, *header, Section::kViewDirections);
  view->visible = section<uint64_t>(block, *header, Section::kVisible);
  view->contour_offsets = section<uint32_t>(block, *header, Section::kContourOffsets);
  view->contours = section<ContourPoint>(block, *header, Section::kContours);
  view->discrete = section<double>(block, *header, Section::kDiscrete);
  view->continuous = section<double>(block, *header, Section::kContinuous);
  const auto name = section<char>(block, *header, Section::kName);
  view->name = {name.data(), name.size()};
  check_contents(*view);

  Model model;
  model.block_ = block;
  model.owner_ = std::move(owner);
  model.view_ = std::move(view);
  return model;
}

Model make_model(const ModelParts& parts) {
  const auto block = std::make_shared<std::vector<std::byte>>((sizeof(ModelHeader) + kAlignment - 1) /
                                                              kAlignment * kAlignment);
  ModelHeader header = parts.header;
  const auto append = [&](Section which, const auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    header.sections[static_cast<size_t>(which)] = {block->size(), values.size()};
    const size_t bytes = values.size() * sizeof(T), at = block->size();
    block->resize((at + bytes + kAlignment - 1) / kAlignment * kAlignment);
    if (bytes > 0) std::memcpy(block->data() + at, static_cast<const void*>(values.data()), bytes);
  };
  append(Section::kPoints, parts.points);
  append(Section::kOffsets, parts.offsets);
  append(Section::kEntries, parts.entries);
  append(Section::kDensePoints, parts.dense_points);
  append(Section::kSupportNormals, parts.support_normals);
  append(Section::kViewDirections, parts.view_directions);
  append(Section::kVisible, parts.visible);
  append(Section::kContourOffsets, parts.contour_offsets);
  append(Section::kContours, parts.contours);
  append(Section::kDiscrete, parts.discrete);
  append(Section::kContinuous, parts.continuous);
  append(Section::kName, parts.name);

  header.magic = kModelMagic;
  header.version = kModelVersion;
  header.size = block->size();
  std::memcpy(block->data(), &header, sizeof(header));
  header.checksum = checksum(*block);
  std::memcpy(block->data(), &header, sizeof(header));
  return Model::from_block(*block, block);
}

size_t Model::View::nearest_view(const Eigen::Vector3f& direction) const {
  size_t best = 0;
  float best_dot = -2;
  for (size_t i = 0; i < view_directions.size(); ++i) {
    const float dot = view_directions[i].dot(direction);
    if (dot > best_dot) best_dot = dot, best = i;
  }
  return best;
}

double Model::diameter() const { return view_->header->diameter; }
size_t Model::point_count() const { return view_->points.size(); }
size_t Model::pair_count() const { return view_->entries.size(); }
std::string Model::name() const { return std::string(view_->name); }

Eigen::Vector3d Model::centre() const {
  const auto& h = *view_->header;
  return (Eigen::Vector3d(h.box_min.data()) + Eigen::Vector3d(h.box_max.data())) / 2;
}

Symmetries Model::symmetries() const {
  Symmetries symmetries;
  for (size_t i = 0; i < view_->discrete.size(); i += 16) {
    RigidTransform t;
    t.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(view_->discrete.data() + i);
    symmetries.discrete.push_back(t);
  }
  for (size_t i = 0; i < view_->continuous.size(); i += 6)
    symmetries.continuous.push_back(
        {Eigen::Vector3d(view_->continuous.data() + i), Eigen::Vector3d(view_->continuous.data() + i + 3)});
  return symmetries;
}

}  // namespace edgepose
