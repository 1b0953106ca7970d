#include "bench/isolated.h"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <system_error>

namespace edgepose::bench {
namespace {

/// What the child sends through the pipe; smaller than PIPE_BUF, so it arrives whole.
struct Message {
  bool found;
  double matrix[16];
  double seconds;
};

[[noreturn]] void answer_and_exit(Method& method, const Object& object, const Frame& frame, int pipe) {
  Message message{};
  try {
    const auto start = std::chrono::steady_clock::now();
    const auto pose = method.find(object, frame);
    message.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    message.found = pose.has_value() && pose->matrix().allFinite();
    if (message.found) Eigen::Map<Eigen::Matrix4d>(message.matrix) = pose->matrix();
  } catch (...) {
    _exit(1);
  }
  _exit(write(pipe, &message, sizeof message) == sizeof message ? 0 : 1);
}

}  // namespace

Answer ask_isolated(Method& method, const Object& object, const Frame& frame, double limit_seconds) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    close(ends[0]);
    answer_and_exit(method, object, frame, ends[1]);
  }
  close(ends[1]);
  pollfd ready{ends[0], POLLIN, 0};
  const bool in_time = poll(&ready, 1, static_cast<int>(1e3 * limit_seconds)) > 0;
  Message message{};
  const bool whole = in_time && read(ends[0], &message, sizeof message) == sizeof message;
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  waitpid(child, nullptr, 0);

  if (!in_time) return {Outcome::kTimedOut, RigidTransform::Identity(), limit_seconds};
  if (!whole) return {Outcome::kCrashed, RigidTransform::Identity(), 0};
  if (!message.found) return {Outcome::kNothing, RigidTransform::Identity(), message.seconds};
  return {Outcome::kAnswered, RigidTransform(Eigen::Matrix4d(Eigen::Map<Eigen::Matrix4d>(message.matrix))),
          message.seconds};
}

}  // namespace edgepose::bench
