#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// The paper's pose errors (Sec. "Evaluation criteria") for one object: ADD if it has no symmetry, ADI' if it
/// has. Up to `max_points` of the mesh's vertices, drawn at random with a fixed seed, stand for the surface.
/// Immutable after construction; safe from any thread.
class PoseError {
 public:
  static constexpr size_t kMaxPoints = 3000;

  /// `mesh` in metres, model frame. Throws std::invalid_argument if it has no vertices.
  PoseError(const Mesh& mesh, bool symmetric, size_t max_points = kMaxPoints, uint64_t seed = 0);
  ~PoseError();
  PoseError(PoseError&&) noexcept;
  PoseError& operator=(PoseError&&) noexcept;

  /// [m] ADI' if the object is symmetric, else ADD. Poses are camera_T_model.
  double operator()(const RigidTransform& truth, const RigidTransform& estimate) const;

  /// [m] mean distance between the same point under both poses.
  double add(const RigidTransform& truth, const RigidTransform& estimate) const;

  /// [m] ADI' = max(mean over x1 of the distance from truth * x1 to the nearest estimate * x2, centre error).
  /// The object's centre is the origin of its model frame, so the centre error is that of the translations.
  double adi(const RigidTransform& truth, const RigidTransform& estimate) const;

  bool symmetric() const { return symmetric_; }
  size_t point_count() const;

 private:
  struct Tree;  // points and the kd-tree over them
  std::unique_ptr<const Tree> tree_;
  bool symmetric_;
};

}  // namespace edgepose
