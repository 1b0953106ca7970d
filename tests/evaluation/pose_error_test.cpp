#include "evaluation/pose_error.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

namespace edgepose {
namespace {

RigidTransform translation(double x, double y, double z) {
  RigidTransform t = RigidTransform::Identity();
  t.translation() = Eigen::Vector3d(x, y, z);
  return t;
}

RigidTransform turn_about_z(double angle) {
  return RigidTransform(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

Mesh points(std::vector<Eigen::Vector3f> vertices) {
  Mesh mesh;
  mesh.vertices = std::move(vertices);
  return mesh;
}

TEST(PoseError, AddOfATranslationIsItsLength) {
  const PoseError error(points({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}), false);
  EXPECT_NEAR(error(turn_about_z(0.3), translation(0.03, 0.04, 0) * turn_about_z(0.3)), 0.05, 1e-12);
}

TEST(PoseError, AddOfAHalfTurnIsTwiceTheMeanRadius) {
  const PoseError error(points({{1, 0, 5}, {0, 3, 0}}), false);
  EXPECT_NEAR(error(RigidTransform::Identity(), turn_about_z(std::numbers::pi)), (2.0 + 6.0) / 2, 1e-12);
}

TEST(PoseError, AdiForgivesATurnOntoItself) {
  const PoseError error(points({{1, 0, 0}, {-1, 0, 0}}), true);
  EXPECT_NEAR(error(RigidTransform::Identity(), turn_about_z(std::numbers::pi)), 0, 1e-12);
  EXPECT_NEAR(error.add(RigidTransform::Identity(), turn_about_z(std::numbers::pi)), 2, 1e-12);
}

TEST(PoseError, AdiIsTheMeanNearestDistanceIfThatIsLarger) {
  // A quarter turn about the centre: each point is sqrt(2) from the nearest of the other pose.
  const PoseError error(points({{1, 0, 0}, {-1, 0, 0}}), true);
  EXPECT_NEAR(error(RigidTransform::Identity(), turn_about_z(std::numbers::pi / 2)), std::sqrt(2.0), 1e-12);
}

TEST(PoseError, AdiIsTheCentreErrorIfThatIsLarger) {
  // Eleven points 0.1 apart, shifted along their line by 0.1: ten of them meet another one.
  std::vector<Eigen::Vector3f> line;
  for (int i = 0; i <= 10; ++i) line.emplace_back(0.1f * static_cast<float>(i), 0.f, 0.f);
  const PoseError error(points(line), true);
  EXPECT_NEAR(error(RigidTransform::Identity(), translation(0.1, 0, 0)), 0.1, 1e-6);
}

TEST(PoseError, AdiSearchesFromTheTruthToTheEstimate) {
  const PoseError error(points({{1, 0, 0}, {0, 3, 0}}), true);
  // Estimate, a quarter turn: (0, 1) and (-3, 0). From the truth: (1, 0) is sqrt(2) and (0, 3) is 2 from (0,
  // 1). The other way it would be sqrt(2) and 4.
  EXPECT_NEAR(error(RigidTransform::Identity(), turn_about_z(std::numbers::pi / 2)), (std::sqrt(2.0) + 2) / 2,
              1e-12);
}

TEST(PoseError, DoesNotDependOnTheCameraFrame) {
  const PoseError error(points({{0.1f, 0.2f, 0}, {0, 0, 0.3f}, {-0.2f, 0, 0.1f}}), true);
  const RigidTransform truth = translation(0, 0, 1) * turn_about_z(1);
  const RigidTransform estimate = translation(0.01, 0.02, 1.01) * turn_about_z(1.2);
  const RigidTransform other(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  EXPECT_NEAR(error.adi(truth, estimate), error.adi(other * truth, other * estimate), 1e-12);
  EXPECT_NEAR(error.add(truth, estimate), error.add(other * truth, other * estimate), 1e-12);
}

TEST(PoseError, DrawsAtMostSoManyPointsAndTheSameOnesAgain) {
  std::vector<Eigen::Vector3f> many;
  for (int i = 0; i < 10000; ++i) many.emplace_back(static_cast<float>(i), 0.f, 0.f);
  const PoseError a(points(many), false), b(points(many), false), other_seed(points(many), false, 3000, 5);
  EXPECT_EQ(a.point_count(), 3000u);
  const RigidTransform turn = turn_about_z(std::numbers::pi);
  const RigidTransform none = RigidTransform::Identity();
  EXPECT_EQ(a(none, turn), b(none, turn));
  EXPECT_NE(a(none, turn), other_seed(none, turn));
  EXPECT_NEAR(a(none, turn), 2 * 4999.5, 400) << "drawn evenly from all, not from one end";
}

TEST(PoseError, RefusesAMeshWithoutVertices) {
  EXPECT_THROW(PoseError(Mesh{}, false), std::invalid_argument);
}

}  // namespace
}  // namespace edgepose
