#include "matcher/surface_sampling.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

TEST(SampleSurface, IsProportionalToArea) {
  // Two triangles of areas 1 : 3 in different planes, and one without area.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {5, 3, 0}, {5, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 1}, {3, 4, 5}};
  const auto points = sample_surface(mesh, 4000, 3);
  ASSERT_EQ(points.size(), 4000u);
  int flat = 0;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const auto& p : points) {
    if (p.position.x() > 4) {
      EXPECT_NEAR(p.normal.x(), 1, 1e-5f);
      EXPECT_LE(p.position.y() / 3 + p.position.z(), 1.0001f);
    } else {
      EXPECT_NEAR(p.normal.z(), 1, 1e-5f);
      EXPECT_LE(p.position.x() + p.position.y(), 1.0001f);
      ++flat, sum += p.position;
    }
  }
  EXPECT_NEAR(flat, 1000, 1);
  EXPECT_NEAR(sum.x() / static_cast<float>(flat), 1.f / 3, 0.03f);  // evenly within the triangle
  EXPECT_NEAR(sum.y() / static_cast<float>(flat), 1.f / 3, 0.03f);
}

TEST(SampleSurface, SameSeedSamePoints) {
  const auto a = sample_surface(fixtures::bracket(), 500, 3), b = sample_surface(fixtures::bracket(), 500, 3),
             c = sample_surface(fixtures::bracket(), 500, 4);
  size_t same = 0;
  for (size_t i = 0; i < 500; ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    same += a[i].position == c[i].position;
  }
  EXPECT_LT(same, 10u);
}

TEST(SampleSurface, RefusesWhatHasNoSurface) {
  Mesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(sample_surface(line, 100, 1), std::invalid_argument);
  Mesh cloud;
  EXPECT_THROW(sample_surface(cloud, 100, 1), std::invalid_argument);
  cloud.vertices.assign(200, Eigen::Vector3f::Zero());
  EXPECT_THROW(sample_surface(cloud, 100, 1), std::invalid_argument) << "no normals";
}

TEST(ThinOut, KeepsTheStepAndLeavesNoHoles) {
  const auto points = sample_surface(fixtures::bracket(), 3000, 5);
  constexpr float kStep = 0.006f;
  const auto kept = thin_out(points, {4 * kStep, kStep});
  const auto first = thin_out(points, {4 * kStep});
  ASSERT_LT(first.size(), kept.size());
  EXPECT_TRUE(std::equal(first.begin(), first.end(), kept.begin())) << "not progressive";
  const auto crowded = [&](uint32_t a, uint32_t b) {
    return (points[a].position - points[b].position).norm() < kStep * 0.9999f &&
           points[a].normal.dot(points[b].normal) > 0;
  };
  for (size_t i = 0; i < kept.size(); ++i)
    for (size_t k = 0; k < i; ++k) ASSERT_FALSE(crowded(kept[i], kept[k]));
  for (uint32_t i = 0; i < points.size(); ++i) {
    bool covered = false;
    for (uint32_t k : kept)
      covered = covered || k == i ||
                ((points[i].position - points[k].position).norm() < kStep * 1.0001f &&
                 points[i].normal.dot(points[k].normal) > 0);
    ASSERT_TRUE(covered);
  }
}

TEST(LargestDistance, IsTheDiagonalOfTheBracket) {
  std::vector<OrientedPoint> corners;
  for (const auto& p : fixtures::bracket().vertices) corners.push_back({p, Eigen::Vector3f::UnitZ()});
  EXPECT_NEAR(largest_distance(corners), std::sqrt(0.08f * 0.08f + 0.05f * 0.05f + 0.04f * 0.04f), 1e-4f);
  EXPECT_EQ(largest_distance({}), 0);
}

}  // namespace
}  // namespace edgepose
