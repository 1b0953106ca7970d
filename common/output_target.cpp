#include "common/output_target.h"

#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"
#include "common/temporary_file.h"

namespace edgepose {
namespace {

constexpr const char* kExpected = "the name of a file to write";

bool same(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

/// What already has the name and must not be replaced; empty if nothing does.
std::string obstacle(const struct stat& status) {
  if (S_ISDIR(status.st_mode)) return "a folder";
  if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) return "a device";
  if (S_ISFIFO(status.st_mode)) return "a pipe";
  if (!S_ISREG(status.st_mode)) return "something that is not a regular file";
  for (const int standard : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat open_file {};
    if (fstat(standard, &open_file) == 0 && same(open_file, status))
      return "the file that standard output or error goes to";
  }
  return "";
}

/// Follows links by hand: the last one may lead to a file that is yet to be made.
std::filesystem::path without_links(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as Linux itself
  std::error_code ignored;
  for (int i = 0; std::filesystem::is_symlink(path, ignored); ++i) {
    if (i == kMostLinks) throw InputError::at(path.string(), kExpected, "links that lead in a circle");
    path = path.parent_path() / std::filesystem::read_symlink(path, ignored);  // an absolute one stands alone
  }
  return path;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  struct stat first {
  }, second{};
  if (stat(a.c_str(), &first) == 0) return stat(b.c_str(), &second) == 0 && same(first, second);
  std::error_code failed;  // neither exists yet: two outputs
  const auto whole = std::filesystem::weakly_canonical(a, failed);
  return !failed && whole == std::filesystem::weakly_canonical(b, failed) && !failed;
}

}  // namespace

std::filesystem::path output_target(const std::filesystem::path& path) {
  if (path.empty()) throw InputError::at("output", kExpected, "an empty name");
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) {
    if (const std::string found = obstacle(status); !found.empty())
      throw InputError::at(path.string(), kExpected, found, "name a file that may be replaced");
  }
  if (!path.has_filename())
    throw InputError::at(path.string(), kExpected, "the name of a folder", "add a file name");
  return without_links(path);
}

void check_output(const std::filesystem::path& path, const std::vector<std::filesystem::path>& others) {
  const std::filesystem::path target = output_target(path);
  for (const std::filesystem::path& other : others)
    if (!other.empty() && same_file(target, other))
      throw InputError::at(path.string(), "an output of its own", "the same file as " + other.string(),
                           "name another file to write");
  const TemporaryFile probe(target);
}

void check_output_folder(const std::filesystem::path& folder) {
  if (folder.empty()) throw InputError::at("output", "the name of a folder to write", "an empty name");
  std::error_code ignored;
  std::filesystem::path above = std::filesystem::absolute(folder);
  while (!std::filesystem::exists(above, ignored) && above.has_relative_path()) above = above.parent_path();
  if (!std::filesystem::is_directory(above, ignored))
    throw InputError::at(folder.string(), "a folder, or a place to make one",
                         above.string() + ", which is no folder", "name another");
  const TemporaryFile probe(above / folder.filename());
}

}  // namespace edgepose
