#include "matcher/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace edgepose {
namespace {

ResidualRows random_rows(size_t count, uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<float> draw(-1, 1);
  ResidualRows rows;
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f arm(draw(generator), draw(generator), draw(generator));
    const Eigen::Vector3f direction =
        Eigen::Vector3f(draw(generator), draw(generator), draw(generator) + 2).normalized();
    rows.append(arm, direction, 0.01f * draw(generator), std::abs(draw(generator)));
  }
  return rows;
}

/// The sums row by row in double precision, whatever the number of rows is left over beside whole lanes.
TEST(NormalEquations, AreTheSumsOverTheRows) {
  for (size_t count : {0u, 1u, 7u, 8u, 9u, 16u, 203u}) {
    const ResidualRows rows = random_rows(count, count + 1);
    Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
    for (size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d arm(rows.arm_x[i], rows.arm_y[i], rows.arm_z[i]),
          direction(rows.dir_x[i], rows.dir_y[i], rows.dir_z[i]);
      Eigen::Matrix<double, 6, 1> j;
      j << arm.cross(direction), direction;
      information += static_cast<double>(rows.weight[i]) * j * j.transpose();
      gradient += static_cast<double>(rows.weight[i]) * static_cast<double>(rows.residual[i]) * j;
    }
    const NormalEquations sums(rows);
    EXPECT_LT((sums.information - information).norm(), 1e-5 * (1 + information.norm())) << count;
    EXPECT_LT((sums.gradient - gradient).norm(), 1e-6 * (1 + gradient.norm())) << count;
  }
}

/// Residuals that a small twist explains lead back to it.
TEST(NormalEquations, FindTheTwistBehindTheResiduals) {
  ResidualRows rows = random_rows(300, 5);
  const Eigen::Vector3f turn(0.01f, -0.02f, 0.005f), shift(0.003f, 0.001f, -0.002f);
  for (size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector3f arm(rows.arm_x[i], rows.arm_y[i], rows.arm_z[i]),
        direction(rows.dir_x[i], rows.dir_y[i], rows.dir_z[i]);
    rows.residual[i] = direction.dot(turn.cross(arm) + shift);
  }
  const Eigen::Matrix<double, 6, 1> twist = NormalEquations(rows).solve(0.5);
  EXPECT_LT((twist.head<3>() - turn.cast<double>()).norm(), 1e-4);
  EXPECT_LT((twist.tail<3>() - shift.cast<double>()).norm(), 1e-4);
}

}  // namespace
}  // namespace edgepose
