#pragma once
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace edgepose::test {

/// A program that runs beside the test; killed when the test ends, however it does.
class Child {
 public:
  /// `arguments[0]` is the program: a path, or looked for in PATH.
  explicit Child(std::vector<std::string> arguments);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  void signal(int number) const;
  /// What it left behind; the test fails if it does not end in time, and it is killed.
  Finished wait(std::chrono::seconds most = std::chrono::seconds(60));
  std::string out() const { return read_file(folder_ / "out"); }  ///< so far
  std::string err() const { return read_file(folder_ / "err"); }

 private:
  Folder folder_;
  pid_t pid_ = 0;
};

/// The program under test with these arguments.
std::vector<std::string> program(const std::vector<std::string>& arguments);

/// Looks again and again until `holds`; false after `most`.
bool eventually(const std::function<bool()>& holds, std::chrono::seconds most = std::chrono::seconds(30));

}  // namespace edgepose::test
