#include "matcher/normal_equations.h"

#include <Eigen/Cholesky>
#include <cstring>

#include "matcher/lanes.h"
#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr int kUnknowns = 6;
constexpr int kProducts = kUnknowns * (kUnknowns + 1) / 2;

struct RowColumns {
  const float *arm_x, *arm_y, *arm_z, *dir_x, *dir_y, *dir_z, *residual, *weight;
};

/// For each lane the products of the unknowns' derivatives, upper triangle by rows, then the gradient.
struct LaneSums {
  float products[kProducts][kLanes], gradient[kUnknowns][kLanes];
};

/// `count`: a multiple of kLanes.
EDGEPOSE_WIDE_SIMD void sum_up(RowColumns rows, size_t count, LaneSums& out) {
  Lanes products[kProducts] = {}, gradient[kUnknowns] = {};
  for (size_t i = 0; i < count; i += kLanes) {
    const Lanes ax = EDGEPOSE_LANES_AT(rows.arm_x, i), ay = EDGEPOSE_LANES_AT(rows.arm_y, i),
                az = EDGEPOSE_LANES_AT(rows.arm_z, i);
    const Lanes dx = EDGEPOSE_LANES_AT(rows.dir_x, i), dy = EDGEPOSE_LANES_AT(rows.dir_y, i),
                dz = EDGEPOSE_LANES_AT(rows.dir_z, i);
    const Lanes weight = EDGEPOSE_LANES_AT(rows.weight, i),
                pull = weight * EDGEPOSE_LANES_AT(rows.residual, i);
    const Lanes j[kUnknowns] = {ay * dz - az * dy, az * dx - ax * dz, ax * dy - ay * dx, dx, dy, dz};
    int k = 0;
#pragma GCC unroll 6
    for (int a = 0; a < kUnknowns; ++a) {
      const Lanes weighted = weight * j[a];
      gradient[a] += pull * j[a];
#pragma GCC unroll 6
      for (int b = a; b < kUnknowns; ++b) products[k++] += weighted * j[b];
    }
  }
  std::memcpy(out.products, products, sizeof products);
  std::memcpy(out.gradient, gradient, sizeof gradient);
}

double sum_of_lanes(const float* lanes) {
  double sum = 0;
  for (size_t l = 0; l < kLanes; ++l) sum += static_cast<double>(lanes[l]);
  return sum;
}

}  // namespace

void ResidualRows::resize(size_t count) {
  for (auto* column : {&arm_x, &arm_y, &arm_z, &dir_x, &dir_y, &dir_z, &residual, &weight})
    column->resize(count);
}

void ResidualRows::append(const Eigen::Vector3f& arm, const Eigen::Vector3f& direction, float how_far,
                          float how_much) {
  arm_x.push_back(arm.x()), arm_y.push_back(arm.y()), arm_z.push_back(arm.z());
  dir_x.push_back(direction.x()), dir_y.push_back(direction.y()), dir_z.push_back(direction.z());
  residual.push_back(how_far);
  weight.push_back(how_much);
}

NormalEquations::NormalEquations(const ResidualRows& rows) {
  // What is left over, fewer than fill the lanes, is summed up with rows of no weight behind it.
  const size_t whole = rows.size() / kLanes * kLanes, rest = rows.size() - whole;
  LaneSums first, last;
  sum_up({rows.arm_x.data(), rows.arm_y.data(), rows.arm_z.data(), rows.dir_x.data(), rows.dir_y.data(),
          rows.dir_z.data(), rows.residual.data(), rows.weight.data()},
         whole, first);
  float tail[8][kLanes] = {};
  const std::vector<float>* columns[] = {&rows.arm_x, &rows.arm_y, &rows.arm_z,    &rows.dir_x,
                                         &rows.dir_y, &rows.dir_z, &rows.residual, &rows.weight};
  for (size_t c = 0; c < 8; ++c)
    for (size_t i = 0; i < rest; ++i) tail[c][i] = (*columns[c])[whole + i];
  sum_up({tail[0], tail[1], tail[2], tail[3], tail[4], tail[5], tail[6], tail[7]}, kLanes, last);
  int k = 0;
  for (int a = 0; a < kUnknowns; ++a) {
    gradient[a] = sum_of_lanes(first.gradient[a]) + sum_of_lanes(last.gradient[a]);
    for (int b = a; b < kUnknowns; ++b, ++k)
      information(a, b) = information(b, a) =
          sum_of_lanes(first.products[k]) + sum_of_lanes(last.products[k]);
  }
}

Eigen::Matrix<double, 6, 1> NormalEquations::solve(double radius) const {
  Eigen::Matrix<double, 6, 6> damped = information;
  const double strength = 1e-4 * information.diagonal().tail<3>().sum();
  damped.diagonal().tail<3>().array() += strength;
  damped.diagonal().head<3>().array() += strength * radius * radius;
  return damped.ldlt().solve(gradient);
}

}  // namespace edgepose
