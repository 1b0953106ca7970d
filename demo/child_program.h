#pragma once
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace edgepose {

/// A program that runs beside this one: in a process group of its own, so that a terminal's Ctrl-C does not
/// end it out of turn, and killed by the kernel should this program die. To be made by the main thread (the
/// kernel goes by the thread that made it). Not thread-safe.
class ChildProgram {
 public:
  /// `path` of the program; what it prints and its standard error go to the file `log`. Throws InputError if
  /// there is no such program or it cannot be started.
  ChildProgram(const std::filesystem::path& path, const std::vector<std::string>& arguments,
               const std::filesystem::path& log);
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;
  ~ChildProgram();  ///< as end(), with two seconds

  /// Throws InputError, with the last of what it said, if it has ended.
  void check();
  /// Asks it to end, and kills it and its group if it has not within so many seconds. Its exit code; -signal.
  int end(double seconds);
  /// Waits until it ends by itself; nothing if it has not within so many seconds.
  std::optional<int> wait(double seconds);

 private:
  std::string last_words() const;

  const std::string name_;
  const std::filesystem::path log_;
  pid_t pid_ = -1;
  std::optional<int> exit_;  ///< once it has ended
};

}  // namespace edgepose
