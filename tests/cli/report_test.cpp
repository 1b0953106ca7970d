#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "client/cli/compare_report.h"
#include "client/cli/match_report.h"
#include "client/cli/plan_report.h"

namespace edgepose {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

RigidTransform some_pose() {
  RigidTransform pose(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()));
  pose.translation() = Eigen::Vector3d(0.1, -0.2, 0.9);
  return pose;
}

Matrix6d some_covariance() {
  Matrix6d root;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = 1e-3 * normal(random);
  return root * root.transpose();
}

NamedResult one_detection() {
  Detection detection;
  detection.camera_T_model = some_pose();
  detection.accepted = true;
  detection.covariance = some_covariance();
  NamedResult named{"thing", "thing.model", 0.1, Eigen::Vector3d(0.01, 0.02, 0.03), {}, {}};
  named.result.detections = {detection};
  return named;
}

TEST(PlanReport, SigmasAgreeWithRandomPerturbations) {
  const NamedResult named = one_detection();
  DrillPlan plan;
  plan.targets.push_back(
      {"hole", {0.03, 0.0, 0.01}, Eigen::Vector3d(1, 1, 0).normalized(), 0.05, 0.004, 1e-3, 0.05});
  const PlanReport report = report_plan(plan, named);
  ASSERT_EQ(report.targets.size(), 1u);
  const PlacedTarget& placed = report.targets.front();
  EXPECT_TRUE(placed.target.entry.isApprox(some_pose() * plan.targets[0].entry, 1e-12));

  const Matrix6d root = some_covariance().llt().matrixL();
  const Eigen::Vector3d centre = some_pose() * named.centre;
  const Eigen::Vector3d axis = placed.target.axis, bottom = placed.target.entry + 0.05 * axis;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero(), tilt = Eigen::Matrix3d::Zero();
  constexpr int kTrials = 40000;
  for (int i = 0; i < kTrials; ++i) {
    Vector6d unit;
    for (int k = 0; k < 6; ++k) unit[k] = normal(random);
    const Vector6d x = root * unit;
    const Eigen::Vector3d w = x.head<3>();
    const Eigen::AngleAxisd turn(w.norm(), w.normalized());
    Eigen::Vector3d shift = turn * (bottom - centre) + centre + x.tail<3>() - bottom;
    shift -= shift.dot(axis) * axis;
    spread += shift * shift.transpose() / kTrials;
    const Eigen::Vector3d lean = turn * axis - axis;
    tilt += lean * lean.transpose() / kTrials;
  }
  const auto worst = [](const Eigen::Matrix3d& m) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues().maxCoeff());
  };
  EXPECT_NEAR(placed.bottom_sigma, worst(spread), 0.03 * worst(spread));
  EXPECT_NEAR(placed.angle_sigma, worst(tilt), 0.03 * worst(tilt));
}

TEST(PlanReport, IsCertainOnlyWithinTheToleranceAndWithAKnownCovariance) {
  DrillPlan plan;
  plan.targets.push_back({"hole", {0, 0, 0}, Eigen::Vector3d::UnitZ(), 0.05, 0.004, 1e-3, 0.05});
  NamedResult named = one_detection();
  Detection& detection = named.result.detections.front();
  const auto certain = [&] { return report_plan(plan, named).targets.front().certain; };
  detection.covariance = 1e-10 * Matrix6d::Identity();
  EXPECT_TRUE(certain());
  detection.covariance = 1e-4 * Matrix6d::Identity();
  EXPECT_FALSE(certain());
  detection.covariance.setZero();
  EXPECT_FALSE(certain());
}

TEST(MatchReport, AnotherFrameTurnsPosesAndCovariances) {
  NamedResult named = one_detection();
  named.result.detections[0].equivalent = {some_pose()};
  const RigidTransform target_T_camera = some_pose().inverse();
  const MatchResult moved = in_frame(target_T_camera, named.result);
  EXPECT_TRUE(moved.detections[0].camera_T_model.isApprox(RigidTransform::Identity(), 1e-12));
  EXPECT_TRUE(moved.detections[0].equivalent[0].isApprox(RigidTransform::Identity(), 1e-12));
  const Eigen::Matrix3d turn = target_T_camera.linear();
  const Matrix6d covariance = some_covariance();
  const Eigen::Matrix3d expected = turn * covariance.topRightCorner<3, 3>() * turn.transpose();
  EXPECT_TRUE((moved.detections[0].covariance.topRightCorner<3, 3>()).isApprox(expected, 1e-9));
}

TEST(MatchReport, NoZeroHasASign) {
  NamedResult named = one_detection();
  named.result.detections[0].camera_T_model.translation() = Eigen::Vector3d(-1e-6, -4e-6, 0.5);
  std::ostringstream out;
  print_table(out, {named}, "camera", 0.01);
  EXPECT_THAT(out.str(), testing::HasSubstr("    0.00     0.00   500.00"));
  EXPECT_THAT(out.str(), testing::Not(testing::HasSubstr("-0.00")));
}

TEST(MatchReport, TableTellsTheReason) {
  NamedResult absent{"thing", "thing.model", 0.1, Eigen::Vector3d::Zero(), {}, {}};
  absent.result.reason = "nothing scored above 0.5";
  std::ostringstream out;
  print_table(out, {absent}, "camera", 0.01);
  EXPECT_THAT(out.str(), testing::HasSubstr("thing            not found: nothing scored above 0.5"));
}

TEST(CompareReport, TellsOfAnswersThatTheDeadlineCutShort) {
  Comparison comparison;
  comparison.answers = 5;
  std::ostringstream whole, cut;
  print_table(whole, comparison);
  EXPECT_THAT(whole.str(), testing::Not(testing::HasSubstr("cut short")));
  comparison.cut_short_b = 2;
  print_table(cut, comparison);
  EXPECT_THAT(cut.str(), testing::HasSubstr("cut short by the daemon's deadline: 0 in A, 2 in B"));
  EXPECT_EQ(to_json(comparison).at("cut_short_b"), 2);
}

}  // namespace
}  // namespace edgepose
