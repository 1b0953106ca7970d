#pragma once
#include <Eigen/Core>
#include <vector>

namespace edgepose {

/// Correspondences as rows of a least-squares problem; structure of arrays.
struct ResidualRows {
  std::vector<float> arm_x, arm_y, arm_z;  ///< [m] from the centre that the twist turns about
  std::vector<float> dir_x, dir_y, dir_z;  ///< unit: along it the residual is measured
  std::vector<float> residual;             ///< [m]
  std::vector<float> weight;               ///< 0: does not count

  void resize(size_t count);
  void append(const Eigen::Vector3f& arm, const Eigen::Vector3f& direction, float how_far, float how_much);
  size_t size() const { return weight.size(); }
};

/// Gauss-Newton sums for a twist (w, v) that moves p to p + w x (p - centre) + v.
struct NormalEquations {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();  ///< sum of weight J J^T
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();     ///< ... weight residual J

  /// Sums up all rows, in an order that depends on their number only.
  explicit NormalEquations(const ResidualRows& rows);

  /// The step; a small prior keeps directions still that nothing holds (a plane's slide, a cylinder's turn).
  /// `radius` [m]: what a radian of turn moves the surface by.
  Eigen::Matrix<double, 6, 1> solve(double radius) const;
};

}  // namespace edgepose
