/// What an output may replace, and what is found out before the work.
#include "common/output_target.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

TEST(OutputTarget, RefusesWhatIsNoRegularFile) {
  const TemporaryFolder folder;
  expect_input_error([] { output_target(""); }, {"empty name"});
  expect_input_error([&] { output_target(folder.path()); }, {folder.path().string(), "a folder"});
  expect_input_error([&] { output_target(folder.path() / "new/"); }, {"folder"});
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_input_error([&] { output_target(folder / "pipe"); }, {"pipe", "a pipe"});
  std::filesystem::create_symlink("pipe", folder / "link");
  expect_input_error([&] { check_output(folder / "link"); }, {"link", "a pipe"});
  std::filesystem::create_symlink("circle", folder / "circle");
  expect_input_error([&] { output_target(folder / "circle"); }, {"circle"});
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
}

TEST(OutputTarget, RefusesADevice) {
  const TemporaryFolder folder;
  // A node of its own: a test that fails must not cost the machine one of its devices.
  if (mknod((folder / "null").c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) GTEST_SKIP() << "needs root";
  expect_input_error([&] { output_target(folder / "null"); }, {"null", "a device"});
}

TEST(CheckOutput, TakesNewFilesAndSuchThatMayBeReplaced) {
  const TemporaryFolder folder;
  check_output(folder / "new", {"", folder / "missing"});
  check_output(folder.write("old", "x"));
  EXPECT_EQ(file_content(folder / "old"), "x");
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

TEST(CheckOutput, RefusesInputsUnderAnyName) {
  const TemporaryFolder folder;
  const auto input = folder.write("in", "x");
  std::filesystem::create_symlink("in", folder / "link");
  std::filesystem::create_hard_link(input, folder / "twin");
  for (const char* name : {"in", "link", "twin", "./in"})
    expect_input_error([&] { check_output(folder.path() / name, {"", input}); }, {name, "the same file as"});
  expect_input_error([&] { check_output(folder / "new", {folder.path() / "." / "new"}); }, {"the same file"});
}

TEST(CheckOutput, RefusesFoldersThatTakeNoFiles) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  expect_input_error([&] { check_output(folder / "no/file"); }, {"no/file", "none"});
  expect_input_error([&] { check_output("/proc/edgepose"); }, {"/proc/edgepose"});
  expect_input_error([&] { check_output_folder(folder.path() / "file" / "below"); }, {"file", "no folder"});
  expect_input_error([&] { check_output_folder("/proc/report"); }, {"/proc/report"});
  check_output_folder(folder.path() / "a" / "b");
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
}

}  // namespace
}  // namespace edgepose
