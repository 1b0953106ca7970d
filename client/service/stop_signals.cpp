#include "client/service/stop_signals.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <condition_variable>
#include <mutex>

namespace edgepose {

StopSignals::StopSignals() {
  sigemptyset(&signals_);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      sigaddset(&signals_, number);
  }
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  descriptor_ = signalfd(-1, &signals_, SFD_CLOEXEC);
  wake_ = eventfd(0, EFD_CLOEXEC);
  thread_ = std::thread([this] { wait(); });
}

StopSignals::~StopSignals() {
  eventfd_write(wake_, 1);
  thread_.join();
  close(wake_);
  close(descriptor_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignals::wait() {
  std::array<pollfd, 2> waits = {{{descriptor_, POLLIN, 0}, {wake_, POLLIN, 0}}};
  while (true) {
    if (poll(waits.data(), waits.size(), -1) < 0) continue;
    if (waits[1].revents != 0) return;
    signalfd_siginfo info{};
    if (read(descriptor_, &info, sizeof(info)) != sizeof(info)) return;
    if (source_.request_stop()) continue;
    // Somebody insists.
    std::signal(static_cast<int>(info.ssi_signo), SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    std::raise(static_cast<int>(info.ssi_signo));
  }
}

bool wait_until(SteadyTime when, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_until(lock, stop, when, [] { return false; });
  return !stop.stop_requested();
}

bool Pacer::wait(const std::stop_token& stop) {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (!start_) start_ = now;
  const double late = std::chrono::duration<double>(now - *start_).count() / period_;
  if (late >= static_cast<double>(next_) + 1) {
    const auto due = static_cast<uint64_t>(late);
    missed_ += due - next_;
    next_ = due;
  }
  return wait_until(*start_ + steady_seconds(static_cast<double>(next_++) * period_), stop);
}

}  // namespace edgepose
