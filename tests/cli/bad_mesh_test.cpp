/// Every damaged mesh that issue "Bad input" names: one line, exit code 2, and no half-written model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

struct Case {
  std::string name;  ///< of the file
  std::string content;
  std::vector<std::string> words;  ///< that the message must hold, besides the file's name
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
      {"metres.ply", bracket_ply(0.1), {"--unit m", "mm"}},
  };
}

class BadMesh : public testing::TestWithParam<Case> {};

TEST_P(BadMesh, IsRefusedInOneLineAndNothingIsWritten) {
  const Folder folder;
  const std::string mesh = folder.write(GetParam().name, GetParam().content);
  std::vector<std::string> words = GetParam().words;
  words.push_back(mesh);
  if (GetParam().name == "metres.ply") words = {mesh, "m"};
  expect_refused(edgepose({"train", mesh, "-o", folder / "out.model"}), words);
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
  // One more vertex that is NaN and one face that uses it; and a face without area.
  std::string mesh = replaced(bracket_ply(100), "vertex 16", "vertex 17");
  mesh = replaced(mesh, "face 24", "face 26");
  mesh = replaced(mesh, "3 0 2 3\n", "nan nan nan\n3 0 1 16\n3 5 5 5\n3 0 2 3\n");
  const Finished run = edgepose({"info", folder.write("mend.ply", mesh)});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr("mended"));
}

TEST(BadMesh, MetresAreReadWhenAskedFor) {
  const Folder folder;
  const Finished run = edgepose({"info", folder.write("metres.ply", bracket_ply(0.1)), "--unit", "m"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr(" mm"));
}

}  // namespace
}  // namespace edgepose::test
