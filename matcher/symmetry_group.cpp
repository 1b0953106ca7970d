#include "matcher/symmetry_group.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace edgepose {
namespace {

constexpr double kTurnDegree = std::numbers::pi / 180;
constexpr double kSame = 4 * kTurnDegree;   // turns that differ by less are one: parts are 15 degrees or more
constexpr double kDrift = 3 * kTurnDegree;  // a product that refinement moves farther is another motion
constexpr size_t kMaxMotions = 60;          // the icosahedron's; with 24 parts about an axis there are 48

double angle_between(const RigidTransform& a, const RigidTransform& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

std::optional<size_t> find(const std::vector<RigidTransform>& motions, const RigidTransform& motion) {
  for (size_t i = 0; i < motions.size(); ++i)
    if (angle_between(motions[i], motion) < kSame) return i;
  return std::nullopt;
}

/// products[i][k]: which motion motions[i] * motions[k] is; empty if it is not a group.
std::vector<std::vector<size_t>> multiply(const std::vector<RigidTransform>& motions) {
  std::vector<std::vector<size_t>> products(motions.size());
  for (size_t i = 0; i < motions.size(); ++i)
    for (const RigidTransform& other : motions) {
      const auto product = find(motions, motions[i] * other);
      if (!product) return {};
      products[i].push_back(*product);
    }
  return products;
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
  return u * svd.matrixV().transpose();
}

}  // namespace

SymmetryGroup::SymmetryGroup(const SelfMatch& self) : self_(self), motions_{RigidTransform::Identity()} {}

bool SymmetryGroup::contains(const RigidTransform& motion) const {
  return find(motions_, motion).has_value();
}

bool SymmetryGroup::turns_about(const Eigen::Vector3d& direction) const {
  return std::any_of(motions_.begin() + 1, motions_.end(), [&](const RigidTransform& m) {
    return std::abs(Eigen::AngleAxisd(m.linear()).axis().dot(direction)) > std::cos(kSame);
  });
}

bool SymmetryGroup::extend(const RigidTransform& motion) {
  if (contains(motion)) return true;
  std::vector<RigidTransform> all = motions_;
  all.push_back(motion);
  for (size_t i = 1; i < all.size(); ++i)
    for (size_t k = 1; k <= i; ++k)
      for (const RigidTransform& product : {all[i] * all[k], all[k] * all[i]}) {
        if (find(all, product)) continue;
        RigidTransform fitted = product;
        if (all.size() >= kMaxMotions || !self_.refine(fitted) || angle_between(fitted, product) > kDrift ||
            !self_.distance(fitted).is_match())
          return false;
        all.push_back(fitted);
      }
  motions_ = std::move(all);
  return true;
}

void SymmetryGroup::make_exact() {
  const auto products = multiply(motions_);
  if (products.empty()) return;
  std::vector<RigidTransform> exact = motions_;
  // Each motion becomes the mean of all the products that say what it is. The error shrinks quadratically.
  for (int round = 0; round < 4; ++round) {
    std::vector<Eigen::Matrix3d> sums(exact.size(), Eigen::Matrix3d::Zero());
    for (size_t i = 0; i < exact.size(); ++i)
      for (size_t k = 0; k < exact.size(); ++k) sums[products[i][k]] += exact[i].linear() * exact[k].linear();
    // Without the last factor the identity would keep an error that the others share.
    const Eigen::Matrix3d identity = nearest_rotation(sums[0]);
    for (size_t i = 0; i < exact.size(); ++i)
      exact[i].linear() = nearest_rotation(sums[i]) * identity.transpose();
  }
  // The point that they leave in place; where they leave it open, on an axis, nearest to the centroid.
  Eigen::Matrix3d a = 1e-6 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < exact.size(); ++i) {
    const Eigen::Matrix3d stays = Eigen::Matrix3d::Identity() - exact[i].linear();
    a += stays.transpose() * stays;
    b += stays.transpose() * (motions_[i] * self_.centroid() - self_.centroid());
  }
  const Eigen::Vector3d fixed = self_.centroid() + a.ldlt().solve(b);
  for (RigidTransform& m : exact) m.translation() = fixed - m.linear() * fixed;
  const bool sound = std::all_of(exact.begin(), exact.end(),
                                 [&](const RigidTransform& m) { return self_.distance(m).is_match(); });
  if (sound) motions_ = std::move(exact);
}

}  // namespace edgepose
