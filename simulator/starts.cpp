#include "simulator/starts.h"

#include <Eigen/Cholesky>

#include "arm/kinematics.h"
#include "arm/rigid_motion.h"
#include "common/error.h"
#include "matcher/option_range.h"
#include "simulator/random_draws.h"
#include "simulator/visibility.h"

namespace edgepose {

std::optional<JointVector> joints_for(const ArmGeometry& arm, const RigidTransform& goal,
                                      const JointVector& near) {
  constexpr int kMaxSteps = 100;
  constexpr double kMaxStep = 0.2, kDamping = 1e-6, kExact = 1e-10;
  JointVector joints = near;
  for (int i = 0; i < kMaxSteps; ++i) {
    const RigidTransform now = base_T_flange(arm, joints);
    Twist off;
    off << goal.translation() - now.translation(), rotation_vector(goal.linear() * now.linear().transpose());
    if (off.norm() < kExact) {
      const bool within =
          (joints.array() >= arm.lower.array()).all() && (joints.array() <= arm.upper.array()).all();
      return within ? std::optional(joints) : std::nullopt;
    }
    const Jacobian jacobian = flange_jacobian(arm, joints);
    const Jacobian square = jacobian * jacobian.transpose() + kDamping * Jacobian::Identity();
    JointVector step = jacobian.transpose() * square.ldlt().solve(off);
    if (const double largest = step.cwiseAbs().maxCoeff(); largest > kMaxStep) step *= kMaxStep / largest;
    joints += step;
  }
  return std::nullopt;
}

std::string StartOptions::check() const {
  return option_fault({{"standoff", standoff, 0, 0.2},
                       {"max_distance", max_distance, 0, 0.3},
                       {"max_turn", max_turn, 0, 1},
                       {"min_clearance", min_clearance, 0, 0.1},
                       {"joint_margin", joint_margin, 0, 1},
                       {"min_visible", min_visible, 0, 1}});
}

JointVector draw_start(const WorkCell& cell, const DrillTarget& target, uint64_t seed,
                       const StartOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError(fault);
  constexpr int kMaxDraws = 1000;
  RandomDraws draws(seed, DrawPurpose::kStart);
  const RigidTransform goal = cell.base_T_model * model_T_tool_at(target, options.standoff);
  for (int i = 0; i < kMaxDraws; ++i) {
    const Eigen::Vector3d turn = draws.within(options.max_turn), shift = draws.within(options.max_distance);
    const RigidTransform tool = goal * rigid_transform(rotation_matrix(turn), shift);
    if (clearance(cell, tool) < options.min_clearance) continue;
    const auto joints = joints_for(cell.arm, tool * cell.flange_T_tool.inverse(), cell.nominal);
    if (!joints) continue;
    const JointVector room = (*joints - cell.arm.lower).cwiseMin(cell.arm.upper - *joints);
    if (room.minCoeff() < options.joint_margin) continue;
    if (visible_share(cell, *joints) >= options.min_visible) return *joints;
  }
  throw InputError::at("start of target '" + target.name + "'", "a pose that the arm reaches",
                       "none in 1000 draws", "another target, or a plan for this model");
}

JointVector standoff_start(const WorkCell& cell, const DrillTarget& target, double standoff) {
  const RigidTransform tool = cell.base_T_model * model_T_tool_at(target, standoff);
  const auto joints = joints_for(cell.arm, tool * cell.flange_T_tool.inverse(), cell.nominal);
  if (!joints)
    throw InputError::at("start of target '" + target.name + "'", "a pose that the arm reaches", "none");
  return *joints;
}

}  // namespace edgepose
