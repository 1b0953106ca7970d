#include "arm/kinematics.h"

#include <gtest/gtest.h>

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>

#include "arm/rigid_motion.h"
#include "tests/arm/arm_draws.h"

namespace edgepose {
namespace {

/// The arm as KDL has it, from the maker's URDF: typed again, so that a slip in ours shows.
KDL::Chain kdl_arm() {
  constexpr double kHalf = std::numbers::pi / 2;
  const auto origin = [](double x, double y, double z, double roll, double pitch, double yaw) {
    return KDL::Frame(KDL::Rotation::RPY(roll, pitch, yaw), KDL::Vector(x, y, z));
  };
  const KDL::Frame origins[kJoints] = {
      origin(0, 0, 0.122, 0, 0, 2 * kHalf),  origin(0, 0.1215, 0, -kHalf, -kHalf, 0),
      origin(0.408, 0, 0, -2 * kHalf, 0, 0), origin(0.376, 0, 0, 2 * kHalf, 0, kHalf),
      origin(0, 0.1025, 0, -kHalf, 0, 0),    origin(0, -0.094, 0, kHalf, 0, 0)};
  KDL::Chain chain;
  // A segment is its joint, then its tip: each origin is the tip of a fixed segment before the joint.
  for (const KDL::Frame& frame : origins) {
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), frame));
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ)));
  }
  return chain;
}

KDL::JntArray kdl_joints(const JointVector& position) {
  KDL::JntArray joints(kJoints);
  joints.data = position;
  return joints;
}

RigidTransform kdl_flange(const KDL::Chain& chain, const JointVector& position) {
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::Frame frame;
  EXPECT_GE(solver.JntToCart(kdl_joints(position), frame), 0);
  RigidTransform pose = RigidTransform::Identity();
  for (int row = 0; row < 3; ++row) {
    pose.translation()[row] = frame.p[row];
    for (int column = 0; column < 3; ++column) pose.linear()(row, column) = frame.M(row, column);
  }
  return pose;
}

TEST(Kinematics, FlangeIsWhereKdlHasIt) {
  const ArmGeometry arm = aubo_i5();
  const KDL::Chain chain = kdl_arm();
  ArmDraws draws(1);
  for (int i = 0; i < 2000; ++i) {
    const JointVector position = draws.joints(arm.lower, arm.upper);
    EXPECT_LT((base_T_flange(arm, position).matrix() - kdl_flange(chain, position).matrix()).norm(), 1e-12);
  }
}

TEST(Kinematics, JacobianIsKdls) {
  const ArmGeometry arm = aubo_i5();
  const KDL::Chain chain = kdl_arm();
  KDL::ChainJntToJacSolver solver(chain);
  ArmDraws draws(2);
  for (int i = 0; i < 2000; ++i) {
    const JointVector position = draws.joints(arm.lower, arm.upper);
    KDL::Jacobian expected(kJoints);
    ASSERT_GE(solver.JntToJac(kdl_joints(position), expected), 0);
    EXPECT_LT((flange_jacobian(arm, position) - expected.data).norm(), 1e-12);
  }
}

TEST(Kinematics, StretchedArmReachesAsFarAsItsDataSheetSays) {
  const ArmGeometry arm = aubo_i5();
  ArmDraws draws(3);
  double farthest = 0;
  for (int i = 0; i < 20000; ++i) {
    JointVector position = draws.joints(arm.lower, arm.upper);
    position[2] = 0;  // the elbow is straight
    farthest = std::max(farthest,
                        (base_T_flange(arm, position).translation() - Eigen::Vector3d(0, 0, 0.122)).norm());
  }
  EXPECT_NEAR(farthest, 0.9, 0.05);  // AUBO i5: 886.5 mm working radius, measured to the wrist
}

TEST(Kinematics, PointVelocityIsTheDerivativeOfThePoint) {
  const ArmGeometry arm = aubo_i5();
  ArmDraws draws(4);
  for (int i = 0; i < 500; ++i) {
    const JointVector position = draws.joints(arm.lower, arm.upper);
    const JointVector velocity = draws.joints(-arm.max_velocity, arm.max_velocity);
    const Eigen::Vector3d point = draws.vector(0.3);
    constexpr double kStep = 1e-6;
    const Eigen::Vector3d difference = (base_T_flange(arm, position + kStep * velocity) * point -
                                        base_T_flange(arm, position - kStep * velocity) * point) /
                                       (2 * kStep);
    EXPECT_LT((point_velocity(arm, position, velocity, point) - difference).norm(), 1e-7);
  }
}

TEST(Kinematics, ConditionIsSmallWhenBentAndHugeWhenStretched) {
  const ArmGeometry arm = aubo_i5();
  EXPECT_LT(condition_number(flange_jacobian(arm, bent())), 17);
  JointVector stretched = bent();
  stretched[2] = 0;
  EXPECT_GT(condition_number(flange_jacobian(arm, stretched)), 1e6);
  JointVector wrist = bent();
  wrist[4] = 0;
  EXPECT_GT(condition_number(flange_jacobian(arm, wrist)), 1e6);
}

TEST(RigidMotion, CarriedTwistIsThatOfTheOtherFrame) {
  ArmDraws draws(5);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform flange_T_camera =
        rigid_transform(rotation_matrix(draws.vector(1)), draws.vector(0.3));
    Twist camera;
    camera << draws.vector(1), draws.vector(1);
    // Both frames, moved for a moment by their twists, must still stand alike to each other.
    constexpr double kStep = 1e-6;
    const auto moved = [&](const Twist& twist) {
      return rigid_transform(rotation_matrix(twist.tail<3>() * kStep), twist.head<3>() * kStep);
    };
    const RigidTransform flange = moved(carried_twist(flange_T_camera, camera));
    const RigidTransform other = flange_T_camera * moved(camera) * flange_T_camera.inverse();
    EXPECT_LT((flange.matrix() - other.matrix()).norm(), 1e-11);
  }
}

TEST(RigidMotion, RotationVectorsComeBack) {
  ArmDraws draws(6);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d vector = draws.vector(1).normalized() * draws.between(0, 3.14);
    EXPECT_LT((rotation_vector(rotation_matrix(vector)) - vector).norm(), 1e-9);
  }
  EXPECT_EQ(rotation_vector(Eigen::Matrix3d::Identity()).norm(), 0);
}

}  // namespace
}  // namespace edgepose
