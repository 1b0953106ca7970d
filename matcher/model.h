#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// How a model is trained. Every length is relative to the model's diameter d, so one set serves all objects.
struct TrainOptions {
  float sampling_step =
      0.05f;  ///< [d] distance between sampled surface points. Table size grows with its -4th power.
  float distance_step = 0.05f;   ///< [d] quantisation of the pair distance (paper: 0.02)
  float angle_step_deg = 12.0f;  ///< [degrees] quantisation of the three angles (paper: 5)
  float min_normal_angle_deg =
      5;  ///< [degrees] pairs whose normals differ by less are left out (Sec. 4.2); 0 keeps all
  float max_normal_angle_deg = 175;  ///< [degrees] ... or by more; 180 keeps all
  bool visibility_filter = true;     ///< drop surface that no outside view sees (insides of CT meshes)
  int views = 240;  ///< view directions for visibility and contours; time and file size grow with it
  bool find_symmetries = true;  ///< match the model against itself, unless symmetries are declared
  uint64_t seed = 1;            ///< of the surface sampling
  int max_table_mb = 256;       ///< [MB] training refuses steps that would make a larger table of point pairs
  int threads = 0;              ///< 0 = all cores; the result does not depend on it

  /// Empty if sound, else one line that names the bad field.
  std::string check() const;
};

/// A line about which the object is round.
struct SymmetryAxis {
  Eigen::Vector3d point;      ///< [m] on the axis, model frame
  Eigen::Vector3d direction;  ///< unit
};
/// The rotations that map the object onto itself: each of `discrete` (`model_T_model`), any turn about each
/// of `continuous`, and their products. What training finds is complete: `discrete` with the identity is a
/// group; a body of revolution has one axis, and one half turn across it if it may be turned over; a sphere
/// has three axes at right angles through its centre.
struct Symmetries {
  std::vector<RigidTransform> discrete;  ///< without the identity
  std::vector<SymmetryAxis> continuous;  ///< any rotation about the axis
  bool empty() const { return discrete.empty() && continuous.empty(); }
  bool is_sphere() const;  ///< any rotation at all: two axes that are not parallel
};

/// A trained model: one contiguous, position-independent block, either built by train_model() or a
/// memory-mapped file (docs/model_file.md). Cheap to copy (shares the block); safe to read from any thread.
class Model {
 public:
  struct View;  // sections of the block, matcher/model_block.h

  /// The whole block, as it is written to a file.
  std::span<const std::byte> block() const { return block_; }
  const View& view() const { return *view_; }

  double diameter() const;         ///< [m] largest distance between two surface points
  size_t point_count() const;      ///< sampled points with a normal
  size_t pair_count() const;       ///< point pairs in the hash table
  Eigen::Vector3d centre() const;  ///< [m] centre of the bounding box, model frame
  Symmetries symmetries() const;
  std::string name() const;

  /// Wraps a block and checks it: magic, version, checksum, section bounds, every index in range.
  /// `owner` keeps the bytes alive. Throws std::invalid_argument: "expected ..., found ...".
  static Model from_block(std::span<const std::byte> block, std::shared_ptr<const void> owner);

 private:
  std::span<const std::byte> block_;
  std::shared_ptr<const void> owner_;
  std::shared_ptr<const View> view_;
};

/// Part of the work done, 0 to 1; called from one thread at a time.
using Progress = std::function<void(double)>;

/// Trains a model (paper Sec. 4.2, Fig. 2 a-e). `mesh` in metres; normals are computed where it has none.
/// `declared` symmetries (BOP models_info.json) are taken as they are: where there are any, none are searched
/// for. Of `name`, 255 bytes are kept; control characters become spaces. Throws std::invalid_argument if the
/// options are unsound or the mesh has no usable surface.
Model train_model(const Mesh& mesh, const std::string& name, const TrainOptions& options = {},
                  const Symmetries& declared = {}, const Progress& progress = {});

}  // namespace edgepose
