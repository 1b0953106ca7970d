#include "evaluation/pose_error.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>
#include <random>
#include <stdexcept>

namespace edgepose {
namespace {

/// `count` different indices below `size`, or all of them; the same for the same seed on every platform (the
/// standard library's distributions are not).
std::vector<size_t> draw_indices(size_t size, size_t count, uint64_t seed) {
  std::vector<size_t> indices(size);
  std::iota(indices.begin(), indices.end(), size_t{0});
  if (size <= count) return indices;
  std::mt19937_64 random(seed);
  for (size_t i = 0; i < count; ++i) std::swap(indices[i], indices[i + random() % (size - i)]);
  indices.resize(count);
  return indices;
}

}  // namespace

struct PoseError::Tree {
  // What nanoflann asks of a point set.
  struct Points {
    std::vector<Eigen::Vector3d> list;
    size_t kdtree_get_point_count() const { return list.size(); }
    double kdtree_get_pt(size_t i, size_t axis) const { return list[i][static_cast<Eigen::Index>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Index =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, size_t>;

  explicit Tree(Points p)
      : points(std::move(p)), index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {
    index.buildIndex();
  }
  double distance_to_nearest(const Eigen::Vector3d& x) const {
    size_t nearest = 0;
    double squared = 0;
    index.knnSearch(x.data(), 1, &nearest, &squared);
    return std::sqrt(squared);
  }

  Points points;
  Index index;
};

PoseError::PoseError(const Mesh& mesh, bool symmetric, size_t max_points, uint64_t seed)
    : symmetric_(symmetric) {
  if (mesh.vertices.empty())
    throw std::invalid_argument("pose error: expected a mesh with vertices, found none");
  Tree::Points points;
  for (size_t i : draw_indices(mesh.vertices.size(), max_points, seed))
    points.list.emplace_back(mesh.vertices[i].cast<double>());
  tree_ = std::make_unique<const Tree>(std::move(points));
}
PoseError::~PoseError() = default;
PoseError::PoseError(PoseError&&) noexcept = default;
PoseError& PoseError::operator=(PoseError&&) noexcept = default;

double PoseError::operator()(const RigidTransform& truth, const RigidTransform& estimate) const {
  return symmetric_ ? adi(truth, estimate) : add(truth, estimate);
}

double PoseError::add(const RigidTransform& truth, const RigidTransform& estimate) const {
  double sum = 0;
  for (const Eigen::Vector3d& x : tree_->points.list) sum += (truth * x - estimate * x).norm();
  return sum / static_cast<double>(point_count());
}

double PoseError::adi(const RigidTransform& truth, const RigidTransform& estimate) const {
  // Distances are the same in every frame: search in the model's own, so that one tree serves all poses.
  const RigidTransform model_T_model = estimate.inverse() * truth;
  double sum = 0;
  for (const Eigen::Vector3d& x : tree_->points.list) sum += tree_->distance_to_nearest(model_T_model * x);
  const double centre_error = (truth.translation() - estimate.translation()).norm();
  return std::max(sum / static_cast<double>(point_count()), centre_error);
}

size_t PoseError::point_count() const { return tree_->points.list.size(); }

}  // namespace edgepose
