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
                   {name});
    expect_refused(edgepose({"match", mesh, "--depth", phantom_file("scene/depth.png"), "--intrinsics",
                             phantom_file("scene/camera.json"), "--overlay", folder / name}),
                   {name, "the same file as"});
  }
  EXPECT_EQ(read_file(mesh), bracket_ply(100));
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
  expect_refused(edgepose({"train", folder / "no.ply", "-o", folder / "no_folder/m"}), {"no_folder/m"});
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
