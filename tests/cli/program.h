#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace edgepose::test {

/// What a finished run of the program left behind.
struct Finished {
  int code = -1;  ///< exit code; -1 if it was killed by a signal
  std::string out, err;
};

/// Runs `edgepose ARGUMENTS...` and waits for it. No shell: arguments may hold anything. With `output`, what
/// it prints goes to that file or device, which must exist, and Finished::out stays empty.
Finished edgepose(const std::vector<std::string>& arguments, const std::string& output = "");

/// Expects exit code 2, nothing on stdout, and one line on stderr, "edgepose: ...", that contains all of
/// `words`.
void expect_refused(const Finished& run, const std::vector<std::string>& words);

/// A folder of its own for one test, removed afterwards.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& content) const;
  /// Names of the files in it, sorted.
  std::vector<std::string> files() const;

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::filesystem::path& path);

/// An ascii PLY of a bracket (two blocks at a right angle), `size` units long. No symmetry.
std::string bracket_ply(double size);

/// A model of the project's phantom, trained once for all tests by the program.
const std::string& phantom_model();

/// models/phantom/NAME in the sources.
std::string phantom_file(const std::string& name);

}  // namespace edgepose::test
