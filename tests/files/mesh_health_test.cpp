#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "files/mesh_health.h"
#include "files/surface_measure.h"
#include "tests/files/bad_input.h"
#include "tests/files/mesh_samples.h"
#include "tests/shared_data.h"

namespace edgepose {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Mends, expects a line about it, and that nothing is left to mend.
Mesh mend(const Mesh& mesh, const std::string& line) {
  MeshHealth health = check_mesh(mesh);
  const Mesh mended = mend_mesh(mesh, health);
  EXPECT_THAT(health.mended, Contains(HasSubstr(line)));
  MeshHealth again = check_mesh(mended);
  mend_mesh(mended, again);
  EXPECT_THAT(again.mended, IsEmpty());
  return mended;
}

TEST(MeshHealth, SoundMeshesStayAsTheyAre) {
  for (const Mesh& mesh : {tetrahedron(), ball(0.05f)}) {
    MeshHealth health = check_mesh(mesh);
    EXPECT_TRUE(health.closed());
    EXPECT_FALSE(health.inverted);
    EXPECT_NEAR(health.signed_volume, signed_volume(mesh), 1e-9);
    EXPECT_EQ(health.parts, 1u);
    EXPECT_THAT(health.warnings, IsEmpty());
    const Mesh mended = mend_mesh(mesh, health);
    EXPECT_THAT(health.mended, IsEmpty());
    EXPECT_EQ(mended.vertices, mesh.vertices);
    EXPECT_EQ(mended.triangles, mesh.triangles);
  }
}

TEST(MeshHealth, SplitVerticesDoNotOpenAMesh) {
  const MeshHealth health = check_mesh(ball(0.05f));  // its poles are many vertices at one place
  EXPECT_EQ(health.open_edges, 0u);
  EXPECT_EQ(health.edges, 3 * health.triangles / 2);
}

TEST(MeshHealth, VerticesThatAreNotFinite) {
  Mesh mesh = ball(0.05f);
  mesh.vertices[100].y() = kNan;
  mesh.vertices[200].z() = -kInfinity;
  MeshHealth health = check_mesh(mesh);
  EXPECT_EQ(health.non_finite_vertices, 2u);
  expect_input_error([&] { mend_mesh(mesh, health, "a.ply"); },
                     {"a.ply: expected finite", "2 of 408 vertices", "export"});
  mesh.triangles.clear();
  health = check_mesh(mesh);
  expect_input_error([&] { mend_mesh(mesh, health, "a.ply"); },
                     {"a.ply: expected finite", "2 of 408 vertices"});
}

TEST(MeshHealth, TooFarFromTheOrigin) {
  Mesh mesh = ball(0.05f);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.x() += 5000;
  MeshHealth health = check_mesh(mesh, {.min_diameter = 0, .max_diameter = 1e9});
  expect_input_error([&] { mend_mesh(mesh, health, "a.ply"); },
                     {"a.ply", "within 1000 m", "5e+03 m", "origin"});
}

TEST(MeshHealth, NothingUsable) {
  Mesh mesh = tetrahedron();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.x() = kNan;
  MeshHealth health = check_mesh(mesh);
  expect_input_error([&] { mend_mesh(mesh, health, "a.stl"); },
                     {"a.stl", "finite coordinates", "4 of 4 vertices"});
  mesh.triangles.clear();
  health = check_mesh(mesh);
  expect_input_error([&] { mend_mesh(mesh, health, "a.ply"); }, {"a.ply", "finite coordinates"});
  mesh = tetrahedron();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = Eigen::Vector3f(vertex.x(), 0, 0);
  health = check_mesh(mesh);
  EXPECT_EQ(health.degenerate_triangles, 4u);
  EXPECT_THROW(mend_mesh(mesh, health), InputError);
  EXPECT_THROW(mend_mesh(Mesh{}, health), InputError);
}

TEST(MeshHealth, DegenerateDoubledAndDanglingTriangles) {
  Mesh mesh = tetrahedron();
  mesh.triangles.push_back({1, 1, 2});
  mesh.triangles.push_back({2, 1, 0});  // the first one again, from another corner
  mesh.triangles.push_back({0, 1, 77});
  mesh.vertices.push_back({9, 9, 9});
  const MeshHealth health = check_mesh(mesh);
  EXPECT_EQ(health.degenerate_triangles, 1u);
  EXPECT_EQ(health.duplicate_triangles, 1u);
  EXPECT_EQ(health.bad_indices, 1u);
  EXPECT_EQ(health.unused_vertices, 1u);
  EXPECT_TRUE(health.closed());
  EXPECT_NEAR(health.diameter, 0.1 * std::sqrt(2.0), 1e-6);  // the point that nobody uses does not count
  mend(mesh, "1 triangle without area");
  mend(mesh, "1 doubled triangle");
  mend(mesh, "1 triangle without their vertices");
  EXPECT_EQ(mend(mesh, "1 point that no triangle uses").triangles.size(), 4u);
}

TEST(MeshHealth, NeedlesAreDroppedButCloseTheSurface) {
  Mesh mesh = tetrahedron();
  // Edge 0-1 split on one side only, the gap closed by a triangle without area.
  mesh.vertices.push_back({0.05f, 0, 0});
  mesh.triangles[1] = {0, 4, 3};
  mesh.triangles.push_back({4, 1, 3});
  mesh.triangles.push_back({0, 1, 4});
  const MeshHealth health = check_mesh(mesh);
  EXPECT_EQ(health.degenerate_triangles, 1u);
  EXPECT_TRUE(health.closed());
  EXPECT_EQ(health.inconsistent_edges, 0u);
}

TEST(MeshHealth, SharesReadAsPeopleWriteThem) {
  Mesh mesh = tetrahedron();
  mesh.triangles = {{0, 2, 1}};  // every edge is open
  EXPECT_THAT(check_mesh(mesh).warnings, Contains(HasSubstr("(100 %)")));
}

TEST(MeshHealth, InsideOut) {
  Mesh mesh = ball(0.05f);
  turn_inside_out(mesh);
  const MeshHealth health = check_mesh(mesh);
  EXPECT_TRUE(health.inverted);
  EXPECT_LT(health.signed_volume, 0);
  const Mesh mended = mend(mesh, "1 of 1 part of the surface, which faced inwards");
  EXPECT_GT(signed_volume(mended), 0);
  for (size_t i = 0; i < mended.vertices.size(); ++i) EXPECT_GT(mended.normals[i].dot(mended.vertices[i]), 0);
}

TEST(MeshHealth, OpenMeshInsideOut) {
  for (const int left_out : {1, 4, 8}) {  // up to a hemisphere
    const Mesh good = ball(0.05f, 16, left_out);
    MeshHealth health = check_mesh(good);
    EXPECT_FALSE(health.inverted);
    EXPECT_EQ(health.open_edges, 24u);
    EXPECT_THAT(health.warnings, Contains(HasSubstr("open mesh: 24 of")));
    Mesh mesh = good;
    turn_inside_out(mesh);
    mesh.normals.clear();
    EXPECT_TRUE(check_mesh(mesh).inverted) << left_out;
    EXPECT_EQ(mend(mesh, "faced inwards").triangles, good.triangles);
  }
}

/// A square of triangles, 0.1 m wide, facing z.
Mesh sheet() {
  Mesh mesh;
  for (int i = 0; i < 121; ++i)
    mesh.vertices.emplace_back(0.01f * static_cast<float>(i % 11), 0.01f * static_cast<float>(i / 11), 0.0f);
  for (uint32_t i = 0; i < 110; ++i) {
    if (i % 11 == 10) continue;
    mesh.triangles.push_back({i, i + 1, i + 11});
    mesh.triangles.push_back({i + 1, i + 12, i + 11});
  }
  return mesh;
}

TEST(MeshHealth, FlatSheetIsLeftAloneUnlessItsNormalsTell) {
  Mesh mesh = sheet();
  MeshHealth health = check_mesh(mesh);
  EXPECT_EQ(health.undecided_parts, 1u);
  EXPECT_THAT(health.warnings, Contains(HasSubstr("the same from both sides")));
  EXPECT_EQ(mend_mesh(mesh, health).triangles, mesh.triangles);
  mesh.normals.assign(mesh.vertices.size(), {0, 0, -1});
  EXPECT_EQ(check_mesh(mesh).undecided_parts, 0u);
  const Mesh mended = mend(mesh, "faced inwards");
  EXPECT_EQ(mended.triangles[0], (std::array<uint32_t, 3>{0, 11, 1}));
  EXPECT_EQ(mended.normals[0], Eigen::Vector3f(0, 0, -1));
}

TEST(MeshHealth, TrianglesThatDisagree) {
  const Mesh good = ball(0.05f);
  std::mt19937 random(3);
  Mesh mesh = good;
  size_t turned = 0;
  for (auto& triangle : mesh.triangles) {
    if (random() % 4) continue;
    std::swap(triangle[1], triangle[2]);
    ++turned;
  }
  EXPECT_GT(check_mesh(mesh).inconsistent_edges, turned);
  EXPECT_NEAR(signed_volume(mend(mesh, "turned " + std::to_string(turned) + " triangles")),
              signed_volume(good), 1e-9);
}

TEST(MeshHealth, PartsAreJudgedOneByOneAndCavitiesStay) {
  Mesh mesh = ball(0.05f);
  Mesh other = ball(0.02f);
  turn_inside_out(other);
  append(mesh, other, {0.2f, 0, 0});  // beside it: wrong
  append(mesh, other, {0, 0, 0});     // within it: a cavity, right
  MeshHealth health = check_mesh(mesh);
  EXPECT_EQ(health.parts, 3u);
  EXPECT_EQ(health.inverted_parts, 1u);
  EXPECT_FALSE(health.inverted);  // not on the whole
  const Mesh mended = mend(mesh, "1 of 3 parts");
  EXPECT_NEAR(signed_volume(mended), signed_volume(ball(0.05f)), 1e-8);
}

TEST(MeshHealth, MoebiusStripHasOneSide) {
  Mesh mesh;
  constexpr uint32_t kSteps = 40;
  for (uint32_t i = 0; i < kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSteps;
    for (const double side : {-0.02, 0.02}) {
      const double radius = 0.1 + side * std::cos(angle / 2);
      mesh.vertices.push_back(
          Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2))
              .cast<float>());
    }
  }
  for (uint32_t i = 0; i < kSteps; ++i) {
    const bool last = i + 1 == kSteps;
    const uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({b, d, c});
  }
  MeshHealth health = check_mesh(mesh);
  EXPECT_EQ(health.unorientable_parts, 1u);
  EXPECT_THAT(health.warnings, Contains(HasSubstr("Moebius")));
  EXPECT_NO_THROW(mend_mesh(mesh, health));
}

TEST(MeshHealth, NormalsOfAllBadKinds) {
  Mesh mesh = ball(0.05f);
  mesh.normals[50].setZero();
  mesh.normals[51] = {kNan, 0, 0};
  mesh.normals[52] *= -1;
  mesh.normals[53] *= 3;
  const MeshHealth health = check_mesh(mesh);
  EXPECT_EQ(health.bad_normals, 2u);
  EXPECT_EQ(health.opposed_normals, 1u);
  EXPECT_EQ(health.non_unit_normals, 1u);
  const Mesh mended = mend(mesh, "2 normals that had no direction");
  const Mesh good = ball(0.05f);
  for (size_t i = 0; i < good.normals.size(); ++i)
    EXPECT_GT(mended.normals[i].dot(good.normals[i]), 0.99) << i;
}

TEST(MeshHealth, AllNormalsZeroAndTooFewNormals) {
  Mesh mesh = ball(0.05f);
  for (Eigen::Vector3f& normal : mesh.normals) normal.setZero();
  MeshHealth health = check_mesh(mesh);
  expect_input_error([&] { mend_mesh(mesh, health, "a.ply"); },
                     {"a.ply", "normals with a direction", "remove the normals"});
  mesh.normals.resize(7);
  health = check_mesh(mesh);
  EXPECT_THAT(health.warnings, Contains(HasSubstr("7 normals")));
  EXPECT_TRUE(mend_mesh(mesh, health).normals.empty());
}

TEST(MeshHealth, BothSidesOfASheetKeepTheirNormals) {
  Mesh mesh = sheet();
  for (const auto& [a, b, c] : sheet().triangles) mesh.triangles.push_back({a, c, b});
  mesh.normals.assign(mesh.vertices.size(), Eigen::Vector3f::Zero());
  mesh.normals[0].z() = 1;
  MeshHealth health = check_mesh(mesh);
  for (const Eigen::Vector3f& normal : mend_mesh(mesh, health).normals) EXPECT_NEAR(normal.norm(), 1, 1e-5);
}

TEST(CloudHealth, NormalsInwardsOrMissing) {
  Mesh cloud = ball(0.05f);
  cloud.triangles.clear();
  EXPECT_FALSE(check_mesh(cloud).inverted);
  EXPECT_TRUE(check_mesh(cloud).is_cloud);
  EXPECT_THAT(check_mesh(cloud).warnings, Contains(HasSubstr("without triangles")));
  for (Eigen::Vector3f& normal : cloud.normals) normal *= -2;
  EXPECT_TRUE(check_mesh(cloud).inverted);
  cloud.normals[30].setZero();
  const Mesh mended = mend(cloud, "pointed inwards");
  EXPECT_EQ(mended.vertices.size(), cloud.vertices.size() - 1);
  for (size_t i = 0; i < mended.vertices.size(); ++i) {
    EXPECT_NEAR(mended.normals[i].dot(mended.vertices[i]), 0.05, 1e-5);
  }
  for (Eigen::Vector3f& normal : cloud.normals) normal.setZero();
  MeshHealth health = check_mesh(cloud);
  expect_input_error([&] { mend_mesh(cloud, health, "a.ply"); }, {"a.ply", "compute the cloud's normals"});
}

TEST(MeshHealth, SizeOutsideTheLimits) {
  EXPECT_EQ(check_mesh(ball(0.05f)).size_complaint(), "");
  EXPECT_THAT(check_mesh(ball(0.0005f)).size_complaint(),
              AllOf(HasSubstr("metres, not millimetres"), HasSubstr("--unit m)"), HasSubstr("--any-size")));
  EXPECT_THAT(check_mesh(ball(50)).size_complaint(),
              HasSubstr("millimetres, not metres (it would be 100 mm with --unit mm)"));
  EXPECT_THAT(check_mesh(ball(1e6f)).size_complaint(), HasSubstr("outside 5 mm to 5 m"));
  EXPECT_EQ(check_mesh(ball(0.0005f), {.min_diameter = 1e-4, .max_diameter = 1}).size_complaint(), "");
}

TEST(MeshHealth, DiameterIsNeverTooLargeAndHardlyTooSmall) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  for (int round = 0; round < 200; ++round) {
    std::vector<Eigen::Vector3f> points(3 + random() % 60);
    for (Eigen::Vector3f& point : points) point = {normal(random), 0.5f * normal(random), 2 * normal(random)};
    double largest = 0;
    for (const auto& a : points) {
      for (const auto& b : points) largest = std::max<double>(largest, (a - b).cast<double>().norm());
    }
    const double estimate = estimate_diameter(points);
    EXPECT_LE(estimate, largest * (1 + 1e-6));
    EXPECT_GE(estimate, largest * 0.99) << round;
  }
}

TEST(MeshHealth, TestSetsNeedNothingMuch) {
  EDGEPOSE_NEEDS_SHARED("range");
  for (const char* set : {"range", "spine", "industrial", "real_bunny", "real_dragon"}) {
    if (!std::filesystem::exists(shared_data(set))) continue;
    for (const auto& file : std::filesystem::directory_iterator(shared_data(set) / "models")) {
      if (file.path().extension() != ".ply") continue;
      const Mesh mesh = read_mesh(file.path());
      MeshHealth health = check_mesh(mesh);
      EXPECT_EQ(health.inverted_parts, 0u) << file.path();
      EXPECT_EQ(health.undecided_parts, 0u) << file.path();
      EXPECT_LT(health.open_edge_share(), 0.03) << file.path();
      const Mesh mended = mend_mesh(mesh, health, file.path().string());
      EXPECT_GT(mended.triangles.size(), mesh.triangles.size() * 8 / 10) << file.path();
    }
  }
}

}  // namespace
}  // namespace edgepose
