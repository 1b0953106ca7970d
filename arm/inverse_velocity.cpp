#include "arm/inverse_velocity.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "arm/kinematics.h"
#include "matcher/option_range.h"

namespace edgepose {
namespace {

constexpr double kLookAhead = 0.01;  // [rad] of the fastest joint, to see where the condition number goes

JointVector damped_least_squares(const Jacobian& jacobian, const Twist& twist, double damping_squared) {
  const Eigen::Matrix<double, 6, 6> normal =
      jacobian * jacobian.transpose() + damping_squared * Eigen::Matrix<double, 6, 6>::Identity();
  return jacobian.transpose() * normal.ldlt().solve(twist);
}

double damping_squared(double smallest_singular_value, const InverseVelocityOptions& options) {
  const double nearness = 1 - std::pow(smallest_singular_value / options.damping_below, 2);
  return std::max(0.0, nearness) * options.max_damping * options.max_damping;
}

bool leaves_singularity(const ArmGeometry& arm, const JointVector& position, const JointVector& velocity,
                        double condition) {
  const double fastest = velocity.cwiseAbs().maxCoeff();
  if (!(fastest > 0)) return false;
  const JointVector ahead = position + velocity * (kLookAhead / fastest);
  return condition_number(flange_jacobian(arm, ahead)) < condition;
}

}  // namespace

std::string InverseVelocityOptions::check() const {
  return option_fault({{"slow_condition", slow_condition, 1, 1000},
                       {"stop_condition", stop_condition, slow_condition * 1.01, 10000},
                       {"leaving_share", leaving_share, 0.001, 1},
                       {"damping_below", damping_below, 1e-4, 1},
                       {"max_damping", max_damping, 1e-4, 1}});
}

InverseVelocity inverse_velocity(const ArmGeometry& arm, const JointVector& position,
                                 const Twist& flange_twist, const InverseVelocityOptions& options) {
  const Jacobian jacobian = flange_jacobian(arm, position);
  const Eigen::JacobiSVD<Jacobian> svd(jacobian);
  const double smallest = svd.singularValues()[kJoints - 1];
  InverseVelocity result;
  result.condition = svd.singularValues()[0] / std::max(smallest, 1e-300);
  result.velocity = damped_least_squares(jacobian, flange_twist, damping_squared(smallest, options));
  const double room =
      (options.stop_condition - result.condition) / (options.stop_condition - options.slow_condition);
  result.share = std::clamp(room, 0.0, 1.0);
  if (result.share < options.leaving_share &&
      leaves_singularity(arm, position, result.velocity, result.condition))
    result.share = options.leaving_share;
  result.velocity *= result.share;
  return result;
}

}  // namespace edgepose
