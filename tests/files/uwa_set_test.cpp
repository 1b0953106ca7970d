#include "files/uwa_set.h"

#include <gmock/gmock.h>

#include <numbers>

#include "files/mesh_file.h"
#include "files/point_spread.h"
#include "files/uwa_names.h"
#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

using testing::HasSubstr;

const std::string kPose = "0 -1 0 10\n1 0 0 -20\n0 0 1 -800\n0 0 0 1\n";

/// A tetrahedron, 100 * `size` mm between its two far corners.
std::string tetrahedron(double size) {
  const std::string s = std::to_string(100 * size), h = std::to_string(40 * size);
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n" +
         s + " 0 0\n" + h + " " + h + " 0\n" + h + " 0 " + h + "\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}
const std::string kCloud =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
    "z\nend_header\n"
    "0 0 -800\n1 0 -800\n";

/// As UWA's archives unpack: three folders, and names that do not quite agree.
void write_uwa_set(const TemporaryFolder& folder) {
  folder.write("models/cheff.ply", tetrahedron(1));
  folder.write("models/T-rex_high.ply", tetrahedron(2));
  folder.write("models/rhino.ply", tetrahedron(3));
  folder.write("scenes/rs1.ply", kCloud);
  folder.write("scenes/rs10.ply", kCloud);
  folder.write("scenes/rs2.ply", kCloud);
  folder.write("GroundTruth_3Dscenes/chef-rs10.xf", kPose);
  folder.write("GroundTruth_3Dscenes/T-rex-rs10.xf", kPose);
  folder.write("GroundTruth_3Dscenes/T-rex-rs2.xf", kPose);
}

TEST(UwaSet, ReadsFolders) {
  const TemporaryFolder folder;
  write_uwa_set(folder);
  const TestSet set = read_test_set(folder.path());
  ASSERT_EQ(set.objects.size(), 2u) << "the rhino is in no ground truth";
  EXPECT_EQ(set.objects[0].name, "T-rex_high");
  EXPECT_EQ(set.objects[0].id, 1);
  EXPECT_NEAR(set.objects[0].diameter, 0.2, 1e-6);
  EXPECT_FALSE(set.objects[0].symmetric);
  EXPECT_EQ(set.objects[1].name, "cheff");
  EXPECT_NEAR(set.objects[1].diameter, 0.1, 1e-6);
  EXPECT_EQ(set.objects[1].mesh, folder / "models/cheff.ply");
  ASSERT_EQ(set.images.size(), 2u);
  EXPECT_EQ(set.images[0].image_id, 2);
  EXPECT_EQ(set.images[0].scene_id, 1);
  EXPECT_EQ(set.images[0].truth.size(), 1u);
  EXPECT_EQ(set.images[1].image_id, 10);
  EXPECT_EQ(set.images[1].cloud, folder / "scenes/rs10.ply");
  EXPECT_TRUE(set.images[1].depth.empty());
  EXPECT_EQ(set.images[1].truth.size(), 2u);
  const Eigen::Vector3d mapped = set.images[0].truth[0].camera_T_model * Eigen::Vector3d(0.1, 0, 0);
  EXPECT_TRUE(mapped.isApprox(Eigen::Vector3d(0.01, 0.08, -0.8)));
}

TEST(UwaSet, ReadsOneFolder) {
  const TemporaryFolder folder;
  folder.write("Chicken.ply", tetrahedron(1));
  folder.write("desk.ply", kCloud);
  folder.write("floor.ply", kCloud);
  folder.write("chicken-desk.xf", kPose);
  folder.write("chicken-floor.xf", kPose);
  const TestSet set = read_uwa_set(folder.path());
  ASSERT_EQ(set.images.size(), 2u);
  EXPECT_EQ(set.images[0].image_id, 1);
  EXPECT_EQ(set.images[1].image_id, 2);
  EXPECT_EQ(set.objects.at(0).name, "Chicken");
}

std::vector<UwaTruthFile> match(const std::string& truth, const std::vector<std::filesystem::path>& plys) {
  return match_uwa_names({truth}, plys);
}

TEST(UwaNames, PrefersTheExactName) {
  EXPECT_EQ(match("chef-rs1.xf", {"cheff.ply", "chef.ply", "rs1.ply"})[0].model, "chef.ply");
  EXPECT_EQ(match("t_rex-rs1.xf", {"T-rex.ply", "T-rex_high.ply", "rs1.ply"})[0].model, "T-rex.ply");
  EXPECT_EQ(match("a-b-c.xf", {"a-b.ply", "a.ply", "c.ply"})[0].model, "a-b.ply");
  EXPECT_EQ(match("a-b-c.xf", {"a.ply", "b-c.ply"})[0].scene, "b-c.ply");
}

TEST(UwaNames, FoldersDecideBetweenEqualNames) {
  const auto found =
      match("chef-rs1.xf", {"scenes/chef.ply", "models/chef.ply", "scenes/rs1.ply", "old/rs1.ply"});
  EXPECT_EQ(found[0].model, "models/chef.ply");
  EXPECT_EQ(found[0].scene, "scenes/rs1.ply");
}

TEST(UwaNames, RefusesWhatRemainsInDoubt) {
  expect_input_error(
      [] {
        match("chef-rs1.xf", {"chef_low.ply", "chef_high.ply", "rs1.ply"});
      },
      {"chef-rs1.xf", "'chef'", "several: chef_low.ply and chef_high.ply"});
  expect_input_error(
      [] {
        match("chef-rs1.xf", {"a/rs1.ply", "b/rs1.ply", "chef.ply"});
      },
      {"'rs1'", "several"});
  expect_input_error([] { match("chef-rs1.xf", {"rs1.ply"}); }, {"chef-rs1.xf", "model 'chef'", "none"});
  expect_input_error(
      [] {
        match("chef-rs2.xf", {"chef.ply", "rs1.ply"});
      },
      {"chef-rs2.xf", "no PLY of that scene"});
  expect_input_error([] { match("chef.xf", {"chef.ply", "rs1.ply"}); }, {"<object>-<scene>.xf"});
  expect_input_error([] { match("-rs1.xf", {"chef.ply", "rs1.ply"}); }, {"<object>-<scene>.xf"});
  expect_input_error([] { match("--rs1.xf", {"chef.ply", "rs1.ply"}); }, {"--rs1.xf", "none"});
  expect_input_error([] { match("rs1-rs1.xf", {"rs1.ply"}); }, {"rs1-rs1.xf", "none"});
}

TEST(UwaSet, RefusesUnsoundPoses) {
  const std::pair<std::string, const char*> cases[] = {
      {"0 -1 0 10 1 0 0 -20 0 0 1 -800 0 0 0", "15 values"},
      {"0 -1 0 10 1 0 0 -20 0 0 1 -800 0 0 0 1 5", "17 values"},
      {"0 1 0 0 -1 0 0 0 0 0 1 0 10 -20 -800 1", "row by row"},
      {"0 -1 0 10 1 0 0 -20 0 0 2 -800 0 0 0 1", "rotation"},
      {"0 1 0 10 1 0 0 -20 0 0 1 -800 0 0 0 1", "mirrors"},
      {"0 -1 0 nan 1 0 0 -20 0 0 1 -800 0 0 0 1", "'nan'"},
      {"0 -1 0 ten 1 0 0 -20 0 0 1 -800 0 0 0 1", "'ten'"},
      {"0 -1 0 1e12 1 0 0 -20 0 0 1 -800 0 0 0 1", "millimetres"},
      {"", "0 values"}};
  for (const auto& [text, found] : cases)
    expect_input_error([&] { parse_xf(text, "a-b.xf"); }, {"a-b.xf", found});
  survive_damage(kPose, 3000, [](const std::string& text) { parse_xf(text, "d.xf"); });
}

TEST(UwaSet, NamesBadFiles) {
  const TemporaryFolder folder;
  write_uwa_set(folder);
  folder.write("GroundTruth_3Dscenes/T-rex-rs2.xf", "");
  expect_input_error([&] { read_test_set(folder.path()); }, {"T-rex-rs2.xf", "empty file"});
  write_uwa_set(folder);
  folder.write("models/cheff.ply", "not a ply");
  expect_input_error([&] { read_test_set(folder.path()); }, {"cheff.ply"});
}

TEST(PointSpread, IsTheDiameter) {
  EXPECT_EQ(largest_spread({}), 0);
  EXPECT_EQ(largest_spread({{1, 2, 3}}), 0);
  EXPECT_NEAR(largest_spread({{0, 0, 0}, {3, 4, 0}}), 5, 1e-6);
  std::mt19937_64 random(7);
  std::normal_distribution<float> normal;
  for (int round = 0; round < 20; ++round) {
    std::vector<Eigen::Vector3f> points(300);
    // Ball, sphere and ellipsoid by turns: the sphere has many ends.
    for (auto& p : points) {
      p = Eigen::Vector3f(normal(random), normal(random), normal(random));
      if (round % 3 == 1) p.normalize();
      if (round % 3 == 2) p.x() *= 4;
    }
    double expected = 0;
    for (const auto& a : points)
      for (const auto& b : points) expected = std::max(expected, static_cast<double>((a - b).norm()));
    const double found = largest_spread(points);
    EXPECT_LE(found, expected * (1 + 1e-6));
    EXPECT_GE(found, expected * 0.999);
  }
}

}  // namespace
}  // namespace edgepose
