#include "server/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

namespace edgepose {
namespace {

using Time = std::chrono::steady_clock::time_point;
constexpr size_t kMaxPrinted = 256 << 10;
constexpr int kLookEvery = 50;  // [ms]
// A tenth of the weight of the matching: it is hardly delayed, and training still ends when all cores are
// busy.
constexpr int kNiceness = 10;
constexpr rlim_t kMaxFile = rlim_t{2} << 30;  // [bytes]

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { reset(); }
  void reset(int number = -1) {
    if (number_ >= 0) close(number_);
    number_ = number;
  }
  int get() const { return number_; }

 private:
  int number_;
};

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
    read.reset(ends[0]);
    write.reset(ends[1]);
  }
  Descriptor read, write;
};

/// A file in memory that holds `input`, to be read from its start.
int file_of(const std::string& input) {
  const int file = memfd_create("input", MFD_CLOEXEC);
  if (file < 0) fail("memfd_create");
  for (size_t done = 0; done < input.size();) {
    const ssize_t written = write(file, input.data() + done, input.size() - done);
    if (written < 0) {
      close(file);
      fail("write");
    }
    done += static_cast<size_t>(written);
  }
  lseek(file, 0, SEEK_SET);
  return file;
}

void limit(int what, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource>(what), &both);
}

/// Between fork and exec of a program with threads: system calls only.
[[noreturn]] void become(char* const* arguments, int in, int out, int err,
                         [[maybe_unused]] const ChildLimits& limits, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCouldNotStart);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (const int score = open("/proc/self/oom_score_adj", O_WRONLY); score >= 0) {
    [[maybe_unused]] const ssize_t written =
        write(score, "1000", 4);  // should memory run out, this one goes first
  }
  syscall(SYS_close_range, 3u, ~0u, 0u);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these reserve terabytes
  if (limits.memory_bytes > 0) limit(RLIMIT_AS, limits.memory_bytes);
#endif
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, kMaxFile);
  setpriority(PRIO_PROCESS, 0, kNiceness);
  execv("/proc/self/exe", arguments);
  _exit(kCouldNotStart);
}

/// False at its end.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 4096> buffer;
  const ssize_t got = read(descriptor, buffer.data(), buffer.size());
  if (got < 0) return errno == EINTR || errno == EAGAIN;
  const size_t room = kMaxPrinted - std::min(kMaxPrinted, text.size());
  text.append(buffer.data(), std::min(static_cast<size_t>(got), room));
  return got > 0;
}

/// Whether the child must end now; `result` says why.
bool is_over(const ChildLimits& limits, Time last, ChildEnd& result) {
  result.timed_out = result.timed_out || Time::clock::now() >= last;
  result.stopped = result.stopped || (limits.stop != nullptr && *limits.stop);
  return result.timed_out || result.stopped;
}

/// Until both streams have ended, the time is over, or it is told to stop.
void read_all(int out, int err, const ChildLimits& limits, Time last, ChildEnd& result) {
  std::array<pollfd, 2> waits = {{{out, POLLIN, 0}, {err, POLLIN, 0}}};
  while (waits[0].fd >= 0 || waits[1].fd >= 0) {
    if (is_over(limits, last, result)) return;
    if (poll(waits.data(), waits.size(), kLookEvery) < 0 && errno != EINTR) return;
    if (waits[0].revents != 0 && !read_some(out, result.out)) waits[0].fd = -1;
    if (waits[1].revents != 0 && !read_some(err, result.err)) waits[1].fd = -1;
  }
}

}  // namespace

ChildEnd run_self(const std::vector<std::string>& arguments, const std::string& input,
                  const ChildLimits& limits) {
  const Descriptor in(file_of(input));
  Pipe out, err;
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), "edgeposed");
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) become(pointers.data(), in.get(), out.write.get(), err.write.get(), limits, parent);
  out.write.reset();
  err.write.reset();

  ChildEnd end;
  const Time last = Time::clock::now() +
                    std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(limits.seconds));
  read_all(out.read.get(), err.read.get(), limits, last, end);
  int status = 0;
  pid_t ended = 0;
  // It may have closed its streams and go on.
  while ((ended = waitpid(child, &status, WNOHANG)) == 0) {
    if (is_over(limits, last, end)) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (ended < 0) fail("waitpid");
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

}  // namespace edgepose
