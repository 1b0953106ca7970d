#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "matcher/model.h"
#include "matcher/oriented_point.h"
#include "matcher/view_sphere.h"

/// The layout of a trained model in memory and in its file (docs/model_file.md). Little endian, sections
/// aligned to 64 bytes, no pointers, so that a file can be mapped and used as it is.
namespace edgepose {

inline constexpr std::array<char, 8> kModelMagic = {'e', 'd', 'g', 'e', 'p', 'o', 's', 'e'};
inline constexpr uint32_t kModelVersion = 2;

/// One pair in the hash table.
struct PairEntry {
  uint16_t reference;  ///< index into `points`
  uint16_t alpha;      ///< alpha_m in 1/65536 turns
};
static_assert(sizeof(PairEntry) == 4);

enum class Section : uint32_t {
  kPoints,          ///< OrientedPoint: even samples a sampling step apart; references of the table
  kOffsets,         ///< uint32: bucket k holds entries [offsets[k], offsets[k + 1])
  kEntries,         ///< PairEntry, sorted by bucket
  kDensePoints,     ///< OrientedPoint: finer samples, every prefix evenly spread; verification and ICP
  kSupportNormals,  ///< Vector3f: for each dense point the normal over as wide a support as the scene's have
  kViewDirections,  ///< Vector3f, unit, from the model to the camera
  kVisible,         ///< uint64 bit sets: for each view, which dense points it shows
  kContourOffsets,  ///< uint32: view v has contour points [offsets[v], offsets[v + 1])
  kContours,        ///< ContourPoint
  kDiscrete,        ///< 16 doubles each, row-major model_T_model
  kContinuous,      ///< 6 doubles each: point, direction
  kName,            ///< UTF-8
  kCount
};

/// Bytes of a model's name.
inline constexpr size_t kMaxModelName = 255;
inline bool is_control(unsigned char c) { return c < ' ' || c == 0x7f; }

/// Starts the block.
struct ModelHeader {
  std::array<char, 8> magic;
  uint32_t version;
  uint32_t distance_bins;  ///< buckets of the pair distance; a bucket is distance_step wide
  uint64_t size;           ///< of the whole block, bytes
  uint64_t checksum;       ///< FNV-1a over every byte but these 8
  double diameter;         ///< [m]
  double sampling_step;    ///< [m] between `points`
  double dense_step;       ///< [m] between dense points
  double distance_step;    ///< [m]
  uint32_t angle_bins;     ///< buckets of each angle over 180 degrees
  uint32_t normal_bin_first, normal_bin_last;  ///< kept buckets of the angle between the normals
  uint32_t reserved;
  std::array<double, 3> box_min, box_max;  ///< [m]
  struct Extent {
    uint64_t offset, count;  ///< bytes from the block's start; elements
  };
  std::array<Extent, static_cast<size_t>(Section::kCount)> sections;
};

class NearModelCache;  // matcher/near_model.h
std::shared_ptr<NearModelCache> make_near_model_cache();

/// The sections as typed spans into the block.
struct Model::View {
  const ModelHeader* header = nullptr;
  std::span<const OrientedPoint> points, dense_points;
  std::span<const uint32_t> offsets, contour_offsets;
  std::span<const PairEntry> entries;
  std::span<const Eigen::Vector3f> support_normals, view_directions;
  std::span<const uint64_t> visible;
  std::span<const ContourPoint> contours;
  std::span<const double> discrete, continuous;
  std::string_view name;
  std::shared_ptr<NearModelCache> near_model =
      make_near_model_cache();  ///< beside the block, made when asked for

  size_t words_per_view() const { return (dense_points.size() + 63) / 64; }
  std::span<const uint64_t> visible_from(size_t view) const {
    return visible.subspan(view * words_per_view(), words_per_view());
  }
  std::span<const ContourPoint> contour_from(size_t view) const {
    return contours.subspan(contour_offsets[view], contour_offsets[view + 1] - contour_offsets[view]);
  }
  /// The stored view nearest to `direction` (unit, model frame, towards the camera).
  size_t nearest_view(const Eigen::Vector3f& direction) const;
};

/// Everything train_model() gathers before it is laid out as a block.
struct ModelParts {
  ModelHeader header{};
  std::vector<OrientedPoint> points, dense_points;
  std::vector<uint32_t> offsets, contour_offsets;
  std::vector<PairEntry> entries;
  std::vector<Eigen::Vector3f> support_normals, view_directions;
  std::vector<uint64_t> visible;
  std::vector<ContourPoint> contours;
  std::vector<double> discrete, continuous;
  std::string name;
};

/// Lays the parts out one behind the other and wraps them.
Model make_model(const ModelParts& parts);

}  // namespace edgepose
