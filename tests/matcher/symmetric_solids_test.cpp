#include <gtest/gtest.h>

#include "matcher/symmetry.h"
#include "tests/matcher/solids.h"

namespace edgepose {
namespace {

using fixtures::Random;

struct Found {
  Symmetries symmetries;
  RigidTransform motion;  // of the solid
  double diameter;
};

/// The symmetries of a solid that was moved at random.
Found find_moved(const Mesh& solid, uint64_t seed) {
  Random random(seed);
  Found found;
  found.motion = RigidTransform::Identity();
  found.motion.linear() = random.rotation();
  found.motion.translation() = random.vector(0.3);
  const auto surface = sample_surface(fixtures::moved(solid, found.motion), 30000, seed);
  const float d = largest_distance(surface);
  std::vector<OrientedPoint> points;
  for (uint32_t i : thin_out(surface, {0.288f * d, 0.144f * d, 0.072f * d, 0.036f * d, 0.018f * d}))
    points.push_back(surface[i]);
  found.symmetries = find_symmetries(points, surface, d);
  found.diameter = d;
  return found;
}

/// The motions and the identity are closed under multiplication, to the last digits.
void expect_group(const std::vector<RigidTransform>& discrete, double diameter) {
  std::vector<RigidTransform> all = discrete;
  all.push_back(RigidTransform::Identity());
  for (const auto& a : all)
    for (const auto& b : all) {
      double nearest = 1;
      for (const auto& c : all)
        nearest = std::min(nearest, ((a * b).linear() - c.linear()).norm() +
                                        ((a * b).translation() - c.translation()).norm() / diameter);
      EXPECT_LT(nearest, 1e-6) << "a product is missing";
    }
}

void expect_turns(const char* name, const Mesh& solid, size_t turns) {
  for (uint64_t seed : {1u, 2u}) {
    SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
    const Found found = find_moved(solid, seed);
    EXPECT_EQ(found.symmetries.discrete.size(), turns);
    EXPECT_TRUE(found.symmetries.continuous.empty());
    expect_group(found.symmetries.discrete, found.diameter);
    for (const auto& turn : found.symmetries.discrete)
      for (const auto& p : solid.vertices) {
        const Eigen::Vector3d moved =
            found.motion.inverse() * (turn * (found.motion * p.cast<double>().eval()));
        double nearest = 1;
        for (const auto& q : solid.vertices) nearest = std::min(nearest, (q.cast<double>() - moved).norm());
        ASSERT_LT(nearest, 0.005 * found.diameter) << "a corner does not come to lie on a corner";
      }
  }
}

TEST(SymmetriesOfSolids, PrismsHaveTheirDihedralGroup) {
  for (int sides : {3, 4, 5, 6, 7, 8, 12, 13, 16})
    expect_turns(("prism " + std::to_string(sides)).c_str(), fixtures::prism(sides, 0.04, 0.07),
                 2 * static_cast<size_t>(sides) - 1);
  expect_turns("plate of 12 sides", fixtures::prism(12, 0.05, 0.006), 23);
}

TEST(SymmetriesOfSolids, FrustumsTurnOnlyAboutTheirAxis) {
  for (int sides : {3, 4, 5, 8, 11})
    expect_turns(("frustum " + std::to_string(sides)).c_str(), fixtures::prism(sides, 0.04, 0.05, 0.6),
                 static_cast<size_t>(sides) - 1);
}

TEST(SymmetriesOfSolids, PlatonicSolidsAndBoxes) {
  expect_turns("tetrahedron", fixtures::tetrahedron(), 11);
  expect_turns("octahedron", fixtures::octahedron(), 23);
  expect_turns("icosahedron", fixtures::icosahedron(), 59);
  expect_turns("cube", fixtures::box(0.05, 0.05, 0.05), 23);
  expect_turns("square bar", fixtures::box(0.03, 0.03, 0.08), 7);
  expect_turns("box", fixtures::box(0.03, 0.05, 0.08), 3);
  expect_turns("nearly a cube", fixtures::box(0.05, 0.053, 0.056), 3);
}

TEST(SymmetriesOfSolids, GearsTurnByTeeth) {
  expect_turns("gear of 7", fixtures::gear(7, 0.05, 0.03), 13);
  expect_turns("gear of 24", fixtures::gear(24, 0.05, 0.02), 47);
}

/// The axis and whether it can be turned over.
void expect_round(const char* name, const Mesh& solid, size_t turned_over) {
  for (uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
    const Found found = find_moved(solid, seed);
    ASSERT_EQ(found.symmetries.continuous.size(), 1u);
    const SymmetryAxis& axis = found.symmetries.continuous[0];
    const Eigen::Vector3d z = found.motion.linear().col(2);
    EXPECT_GT(std::abs(axis.direction.dot(z)), std::cos(0.2 * std::numbers::pi / 180));
    EXPECT_LT((axis.point - found.motion.translation()).cross(z).norm(), 0.002 * found.diameter);
    ASSERT_EQ(found.symmetries.discrete.size(), turned_over);
    for (const auto& turn : found.symmetries.discrete) {
      EXPECT_NEAR((turn.linear() * axis.direction).dot(axis.direction), -1, 1e-9) << "exactly upside down";
      EXPECT_LT((turn * found.motion.translation() - found.motion.translation()).norm(),
                0.004 * found.diameter);
    }
  }
}

TEST(SymmetriesOfSolids, BodiesOfRevolutionHaveOneAxisAndPerhapsAHalfTurn) {
  expect_round("cylinder", fixtures::cylinder(0.03, 0.1), 1);
  expect_round("disc", fixtures::cylinder(0.05, 0.01), 1);
  expect_round("cylinder with equal moments", fixtures::cylinder(0.03, 0.03 * std::sqrt(3.0)), 1);
  expect_round("cone", fixtures::lathe({{0, -0.03}, {0.04, -0.03}, {0, 0.05}}), 0);
}

TEST(SymmetriesOfSolids, ASphereIsThreeAxesThroughItsCentre) {
  const Found found = find_moved(fixtures::sphere(0.04), 4);
  EXPECT_TRUE(found.symmetries.is_sphere());
  EXPECT_TRUE(found.symmetries.discrete.empty());
  ASSERT_EQ(found.symmetries.continuous.size(), 3u);
  for (const SymmetryAxis& axis : found.symmetries.continuous)
    EXPECT_LT((axis.point - found.motion.translation()).norm(), 0.002 * found.diameter);
  EXPECT_NEAR(found.symmetries.continuous[0].direction.dot(found.symmetries.continuous[1].direction), 0,
              1e-9);
}

TEST(SymmetriesOfSolids, ADentTakesThemAway) {
  Mesh dented = fixtures::cylinder(0.03, 0.04);
  for (auto& p : dented.vertices)  // one side flattened
    p.x() = std::min(p.x(), 0.022f);
  const Found found = find_moved(dented, 5);
  EXPECT_TRUE(found.symmetries.continuous.empty());
  EXPECT_EQ(found.symmetries.discrete.size(), 1u) << "only upside down about the flattened side";
  EXPECT_FALSE(found.symmetries.is_sphere());
}

}  // namespace
}  // namespace edgepose
