/// What the program writes: nothing that exists is replaced by mistake, nothing is lost without a word.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <fstream>

#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;

std::vector<std::string> match_phantom(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"match",        phantom_model(),
                                        "--depth",      phantom_file("scene/depth.png"),
                                        "--intrinsics", phantom_file("scene/camera.json")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Output, IsNeverTheInput) {
  const Folder folder;
  const std::string mesh = folder.write("bracket.ply", bracket_ply(100));
  std::filesystem::create_symlink("bracket.ply", folder / "link");
  for (const char* name : {"bracket.ply", "link"}) {
    expect_refused(edgepose({"train", mesh, "-o", folder / name}), {name, "the same file as", "bracket.ply"});
    expect_refused(edgepose({"render", "--mesh", mesh, "--pose", "0 0 400 0 0 0", "-o", folder / name}),
                   {name, "the same file as"});
    expect_refused(edgepose({"match", mesh, "--depth", phantom_file("scene/depth.png"), "--intrinsics",
                             phantom_file("scene/camera.json"), "--overlay", folder / name}),
                   {name, "the same file as"});
  }
  EXPECT_EQ(read_file(mesh), bracket_ply(100));
}

TEST(Output, IsNeverATestSetsOwnFile) {
  const Folder folder;
  std::filesystem::create_directories(folder / "models");
  std::filesystem::create_directories(folder / "test/000001/depth");
  folder.write("models/obj_000001.ply", bracket_ply(100));
  folder.write("models/models_info.json", R"({"1": {"diameter": 100}})");
  const std::string scene = folder / "test/000001/";
  folder.write("test/000001/scene_camera.json",
               R"({"0": {"cam_K": [600, 0, 320, 0, 600, 240, 0, 0, 1], "depth_scale": 0.1}})");
  folder.write(
      "test/000001/scene_gt.json",
      R"({"0": [{"obj_id": 1, "cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 400]}]})");
  std::filesystem::copy(phantom_file("scene/depth.png"), scene + "depth/000000.png");
  for (const std::string& file :
       {scene + "scene_gt.json", scene + "scene_camera.json", scene + "depth/000000.png",
        folder / "models/models_info.json", folder / "models/obj_000001.ply"}) {
    const std::string before = read_file(file);
    expect_refused(edgepose({"eval", folder / "", "--results", file}), {"the same file as"});
    EXPECT_EQ(read_file(file), before) << file;
  }
}

TEST(Output, JsonTakesNamesThatAreNoUtf8) {
  const Folder folder;
  const std::string mesh = folder.write("t\xff.ply", bracket_ply(100));
  const Finished run = edgepose({"info", mesh, "--json"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("t\xef\xbf\xbd.ply"));
}

TEST(Output, NeedsAName) {
  const Folder folder;
  const std::string mesh = folder.write("bracket.ply", bracket_ply(100));
  expect_refused(edgepose({"train", mesh, "-o", ""}), {"--output", "empty"});
  expect_refused(edgepose(match_phantom({"--overlay", ""})), {"--overlay", "empty"});
  expect_refused(edgepose({"eval", folder / "", "--report", ""}), {"--report", "empty"});
}

TEST(Output, LeavesDevicesPipesAndFoldersAlone) {
  const Folder folder;
  const std::string mesh = folder.write("bracket.ply", bracket_ply(100));
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_refused(edgepose({"train", mesh, "-o", folder / "pipe"}), {"pipe", "a pipe"});
  expect_refused(edgepose({"train", mesh, "-o", folder / ""}), {"folder"});
  // A node of the test's own: if the program replaced it, the machine would keep its devices.
  if (mknod((folder / "null").c_str(), S_IFCHR | 0600, makedev(1, 3)) == 0) {
    expect_refused(edgepose({"train", mesh, "-o", folder / "null"}), {"null", "a device"});
    EXPECT_TRUE(std::filesystem::is_character_file(folder / "null"));
  }
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
}

TEST(Output, GoesToWhatALinkLeadsTo) {
  const Folder folder;
  const std::string mesh = folder.write("bracket.ply", bracket_ply(100));
  std::filesystem::create_symlink("m.model", folder / "latest");
  EXPECT_EQ(edgepose({"train", mesh, "-o", folder / "latest"}).code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "latest"));
  EXPECT_EQ(edgepose({"info", folder / "m.model"}).code, 0);
}

TEST(Output, AFolderThatIsMissingIsNoticedBeforeTheWork) {
  const Folder folder;
  // Inputs that are missing, too: the complaint about the output shows that it comes first.
  expect_refused(edgepose({"train", folder / "no.ply", "-o", folder / "no_folder/m"}),
                 {"no_folder/m: expected the folder ", "no_folder, found none; make it first"});
  expect_refused(edgepose({"match", folder / "no.model", "--cloud", folder / "no.ply", "--overlay",
                           folder / "no_folder/o.png"}),
                 {"no_folder/o.png"});
  expect_refused(edgepose({"render", "--mesh", folder / "no.ply", "--pose", "0 0 400 0 0 0", "-o",
                           folder / "no_folder/d.png"}),
                 {"no_folder/d.png"});
  EXPECT_THAT(folder.files(), testing::IsEmpty());
}

TEST(Output, IsNotLostWithoutAWord) {
  const Folder folder;
  const std::string full = folder / "full";
  if (mknod(full.c_str(), S_IFCHR | 0600, makedev(1, 7)) != 0 || !std::ofstream(full).is_open())
    GTEST_SKIP() << "needs the right to make a device that is always full";
  expect_refused(edgepose({"--help"}, full), {"standard output"});
  expect_refused(edgepose({"--version"}, full), {"standard output"});
  expect_refused(edgepose(match_phantom({}), full), {"standard output"});
  expect_refused(edgepose(match_phantom({"--accept", "1", "--json"}), full), {"standard output"});
}

}  // namespace
}  // namespace edgepose::test
