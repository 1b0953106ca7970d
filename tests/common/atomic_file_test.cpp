/// Files that are written aside and renamed, alone and in groups.
#include "common/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

size_t entries(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator list(folder);
  return static_cast<size_t>(std::distance(begin(list), end(list)));
}

TEST(AtomicFile, ReplacesTheContentAndKeepsTheMode) {
  const TemporaryFolder folder;
  const auto path = folder.write("a", "old");
  ASSERT_EQ(chmod(path.c_str(), 0640), 0);
  write_file_atomically(path, "new");
  EXPECT_EQ(file_content(path), "new");
  struct stat status {};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, WritesToWhatALinkLeadsTo) {
  const TemporaryFolder folder;
  folder.write("deep/old", "old");
  std::filesystem::create_symlink("deep/old", folder / "link");
  std::filesystem::create_symlink(folder / "link", folder / "link_to_link");
  std::filesystem::create_symlink("deep/new", folder / "dangling");
  write_file_atomically(folder / "link_to_link", "1");
  write_file_atomically(folder / "dangling", "2");
  EXPECT_EQ(file_content(folder / "deep/old"), "1");
  EXPECT_EQ(file_content(folder / "deep/new"), "2");
  for (const char* link : {"link", "link_to_link", "dangling"})
    EXPECT_TRUE(std::filesystem::is_symlink(folder / link)) << link;
}

TEST(AtomicFile, NamesAFolderThatIsMissing) {
  expect_input_error([] { write_file_atomically("no_such_folder/a", "x"); }, {"no_such_folder/a", "none"});
}

TEST(FileGroup, AppearsAsAWholeOrNotAtAll) {
  const TemporaryFolder folder;
  folder.write("a", "old");
  {
    FileGroup files;
    files.make_folder(folder / "report/plots");
    files.add(folder / "a", "new");
    files.add(folder / "report/plots/b", "b");
    EXPECT_EQ(file_content(folder / "a"), "old");
  }
  EXPECT_EQ(entries(folder.path()), 1u) << "the folder that was made for nothing is gone";
  FileGroup files;
  files.make_folder(folder / "report/plots");
  EXPECT_EQ(file_content(files.add(folder / "a", "new")), "new") << "may be read before it is in place";
  files.add(folder / "report/plots/b", "b");
  files.commit();
  EXPECT_EQ(file_content(folder / "a"), "new");
  EXPECT_EQ(file_content(folder / "report/plots/b"), "b");
  EXPECT_EQ(entries(folder.path()), 2u);
}

TEST(TemporaryFile, IsRemovedWhenASignalEndsTheProgram) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryFolder folder;
    const pid_t child = fork();
    if (child == 0) {
      remove_temporary_files_on_signals();
      TemporaryFile first(folder / "a"), second(folder / "b");
      TemporaryFile moved = std::move(second);
      raise(number);
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == number);
    EXPECT_EQ(entries(folder.path()), 0u);
  }
}

}  // namespace
}  // namespace edgepose
