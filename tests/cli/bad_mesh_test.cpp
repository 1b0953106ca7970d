/// Every damaged mesh that issue "Bad input" names: one line, exit code 2, and no half-written model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

struct Case {
  std::string name;  ///< of the file
  std::string content;
  std::vector<std::string> words;  ///< that the message must hold, besides the file's name

  /// How gtest names it in lists; else it prints the bytes.
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string binary_stl(uint32_t claimed, uint32_t stored) {
  std::string bytes(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&claimed), sizeof claimed);
  for (uint32_t i = 0; i < stored; ++i) {
    const float values[12] = {0, 0, 1, 0, 0, 0, static_cast<float>(i) + 1, 0, 0, 0, 1, 0};
    bytes.append(reinterpret_cast<const char*>(values), sizeof values);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string pcd(const std::string& points, const std::string& body) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + points +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA ascii\n" + body;
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

/// `ply` with the same normal at each of its 16 vertices.
std::string with_normals(std::string ply, const std::string& normal) {
  ply = replaced(ply, kXyz, kXyz + "property float nx\nproperty float ny\nproperty float nz\n");
  size_t end = ply.find("end_header\n") + 11;
  for (int i = 0; i < 16; ++i) {
    end = ply.find('\n', end);
    ply.insert(end, " " + normal);
    end = ply.find('\n', end) + 1;
  }
  return ply;
}

std::string without_faces(std::string ply) {
  const size_t faces = ply.find("element face");
  ply.erase(faces, ply.find("end_header") - faces);
  return ply.erase(ply.find("3 0 2 3\n"));
}

/// A spiral without normals.
std::string cloud_ply(int points) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points) + "\n" + kXyz + "end_header\n";
  for (int i = 0; i < points; ++i) {
    ply += std::to_string(50 * std::cos(0.3 * i)) + " " + std::to_string(50 * std::sin(0.3 * i)) + " " +
           std::to_string(i) + "\n";
  }
  return ply;
}

/// A tetrahedron of 2 m, 10 km away from the origin.
std::string far_away_obj() {
  return "v 1e7 0 0\nv 10002000 0 0\nv 1e7 2000 0\nv 1e7 0 2000\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

std::vector<Case> cases() {
  const std::string sound = bracket_ply(100);
  return {
      {"empty.ply", "", {"empty"}},
      {"truncated.ply", sound.substr(0, sound.size() / 2), {"expected", "found"}},
      {"header_only.ply", sound.substr(0, sound.find("end_header")), {"end_header"}},
      {"lying.ply", replaced(sound, "vertex 16", "vertex 1000000016"), {"1000000016"}},
      {"lying_faces.ply", replaced(sound, "face 24", "face 1000000024"), {"1000000024"}},
      {"negative.ply", replaced(sound, "vertex 16", "vertex -16"), {"-16"}},
      {"index.ply", replaced(sound, "3 0 2 3", "3 0 2 300"), {"300"}},
      {"text.ply", "This is not a mesh.\n", {"expected"}},
      {"stl_inside.ply", binary_stl(2, 2), {"expected"}},
      {"ply_inside.stl", sound, {"expected"}},
      {"empty.stl", "", {"empty"}},
      {"lying.stl", binary_stl(1000000000, 4), {"1000000000"}},
      {"truncated.stl", binary_stl(12, 12).substr(0, 200), {"expected"}},
      {"no_faces.stl", "solid nothing\nendsolid nothing\n", {"expected"}},
      {"no_faces.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\n", {"expected"}},
      {"index.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 9\n", {"9"}},
      {"word.obj", "v 0 zero 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n", {"zero"}},
      {"lying.pcd", pcd("1000000000", "0 0 0\n1 0 0\n"), {"1000000000"}},
      {"truncated.pcd", pcd("40", "0 0 0\n1 0 0\n"), {"expected"}},
      {"empty.pcd", "", {"empty"}},
      {"all_nan.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
       "z\nelement face "
       "1\nproperty list uchar int vertex_indices\nend_header\nnan nan nan\nnan nan nan\nnan nan nan\n3 0 1 "
       "2\n",
       {"expected", "found"}},
      {"one_nan.ply", replaced(sound, "\n0 0 0\n", "\nnan 0 0\n"), {"finite", "1 of 16 vertices"}},
      {"infinite.obj", "v 0 0 0\nv 100 0 0\nv 0 inf 0\nv 0 0 100\nf 1 2 3\nf 1 2 4\n", {"finite", "1 of 4"}},
      {"nan_cloud.pcd", pcd("3", "0 0 0\n100 0 0\nnan nan nan\n"), {"finite", "1 of 3"}},
      {"zero_normals.ply", with_normals(sound, "0 0 0"), {"normals with a direction", "remove the normals"}},
      {"zero_normals_cloud.ply", without_faces(with_normals(sound, "0 0 0")), {"normals with a direction"}},
      {"few_points.ply", without_faces(with_normals(sound, "0 0 1")), {"100 points"}},
      {"bare_cloud.ply", cloud_ply(200), {"normal"}},
      {"far_away.obj", far_away_obj(), {"within 1000 m", "origin"}},
      {"short.stl", std::string(82, 'x'), {"84 bytes", "82 bytes"}},
      {"metres.ply", bracket_ply(0.1), {"--unit m", "mm", "--any-size"}},
  };
}

class BadMesh : public testing::TestWithParam<Case> {};

TEST_P(BadMesh, IsRefusedInOneLineAndNothingIsWritten) {
  const Folder folder;
  const std::string mesh = folder.write(GetParam().name, GetParam().content);
  std::vector<std::string> words = GetParam().words;
  words.push_back(mesh);
  expect_refused(edgepose({"train", mesh, "-o", folder / "out.model"}), words);
  // Only training asks for more points, or for normals.
  if (mesh.find("few_points") == std::string::npos && mesh.find("bare_cloud") == std::string::npos)
    expect_refused(edgepose({"info", mesh}), words);
  EXPECT_THAT(folder.files(), testing::ElementsAre(GetParam().name));
}

INSTANTIATE_TEST_SUITE_P(Files, BadMesh, testing::ValuesIn(cases()), [](const auto& parameter) {
  std::string name = parameter.param.name;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

TEST(BadMesh, MissingFilesFoldersAndDevicesAreNamed) {
  const Folder folder;
  expect_refused(edgepose({"train", folder / "no.ply", "-o", folder / "m"}), {folder / "no.ply"});
  expect_refused(edgepose({"train", folder / "", "-o", folder / "m"}), {"expected"});
  expect_refused(edgepose({"info", "/dev/null"}), {"/dev/null"});
}

TEST(BadMesh, OutputThatCannotBeWrittenIsNamed) {
  const Folder folder;
  const std::string mesh = folder.write("bracket.ply", bracket_ply(100));
  const Finished run = edgepose({"train", mesh, "-o", folder / "no_such_folder/out.model"});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, testing::HasSubstr("no_such_folder/out.model"));
  EXPECT_THAT(folder.files(), testing::ElementsAre("bracket.ply"));
}

TEST(BadMesh, WhatCanBeMendedIsMendedAndSaid) {
  const Folder folder;
  std::string mesh = replaced(bracket_ply(100), "face 24", "face 25");
  mesh = replaced(mesh, "3 0 2 3\n", "3 5 5 5\n3 0 2 3\n");  // a face without area
  const Finished run = edgepose({"info", folder.write("mend.ply", mesh)});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr("mended"));
}

TEST(BadMesh, AnySizeIsTakenWhenAskedFor) {
  const Folder folder;
  const std::string small = folder.write("small.ply", bracket_ply(3)),
                    large = folder.write("large.ply", bracket_ply(8e3));
  for (const std::string& mesh : {small, large}) {
    expect_refused(edgepose({"info", mesh}), {mesh, "--any-size"});
    expect_refused(edgepose({"train", mesh, "-o", folder / "m"}), {mesh, "--any-size"});
    EXPECT_EQ(edgepose({"info", mesh, "--any-size"}).code, 0);
    EXPECT_EQ(edgepose({"train", mesh, "-o", folder / "m", "--any-size"}).code, 0);
  }
}

TEST(BadMesh, MetresAreReadWhenAskedFor) {
  const Folder folder;
  const Finished run = edgepose({"info", folder.write("metres.ply", bracket_ply(0.1)), "--unit", "m"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr(" mm"));
}

}  // namespace
}  // namespace edgepose::test
