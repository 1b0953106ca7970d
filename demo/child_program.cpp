#include "demo/child_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr int kNotExecuted = 127;
constexpr size_t kLastLines = 3, kLastBytes = 600;

/// Between fork and exec of a program with threads: system calls only.
[[noreturn]] void become_program(char* const* arguments, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kNotExecuted);
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  syscall(SYS_close_range, 3u, ~0u, 0u);
  execv(arguments[0], arguments);
  _exit(kNotExecuted);
}

}  // namespace

ChildProgram::ChildProgram(const std::filesystem::path& path, const std::vector<std::string>& arguments,
                           const std::filesystem::path& log)
    : name_(path.filename()), log_(log) {
  if (access(path.c_str(), X_OK) != 0)
    throw InputError::at(path.string(), "a program", std::strerror(errno),
                         "edgepose-servo demo starts those that lie beside it");
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) throw InputError::at(log.string(), "a file that can be written", std::strerror(errno));
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), path);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become_program(pointers.data(), file, parent);
  const int fault = errno;
  close(file);
  if (pid_ < 0) throw InputError::at(name_, "a process for it", std::strerror(fault));
  setpgid(pid_, pid_);  // here as well: whoever comes first
}

ChildProgram::~ChildProgram() { end(2); }

std::optional<int> ChildProgram::wait(double seconds) {
  const auto last = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!exit_) {
    int status = 0;
    const pid_t ended = waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) exit_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (ended < 0 && errno != EINTR) exit_ = kNotExecuted;
    if (exit_ || std::chrono::steady_clock::now() >= last) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return exit_;
}

int ChildProgram::end(double seconds) {
  if (!exit_) {
    kill(pid_, SIGTERM);
    if (!wait(seconds)) kill(-pid_, SIGKILL);
    wait(10);
  }
  return exit_.value_or(-SIGKILL);
}

void ChildProgram::check() {
  if (!wait(0)) return;
  const std::string how =
      *exit_ < 0 ? "by signal " + std::to_string(-*exit_) : "with exit code " + std::to_string(*exit_);
  throw InputError(name_ + " ended " + how + ": " + last_words());
}

std::string ChildProgram::last_words() const {
  std::ifstream file(log_, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  size_t from = text.size();
  for (size_t lines = 0; lines < kLastLines && from != std::string::npos && from > 0; ++lines)
    from = text.rfind('\n', from - 1);
  const std::string last = text.substr(text.rfind('\n') + 1);
  if (last.starts_with(name_ + ": ")) return one_line(last);  // why it gave up, in its own words
  text = text.substr(from == std::string::npos ? 0 : from);
  if (text.size() > kLastBytes) text = "..." + text.substr(text.size() - kLastBytes);
  return text.empty() ? "it said nothing" : one_line(text);
}

}  // namespace edgepose
