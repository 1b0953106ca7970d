#include "daemon/signals.h"

#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>

namespace edgepose {

Signals::Signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);
  signals_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  ending_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  timer_ = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  if (signals_ < 0 || ending_ < 0 || timer_ < 0)
    throw std::system_error(errno, std::generic_category(), "signals");
}

Signals::~Signals() {
  for (const int descriptor : {signals_, ending_, timer_}) close(descriptor);
}

Wake Signals::wait(int period) {
  itimerspec current{};
  timerfd_gettime(timer_, &current);
  if (current.it_interval.tv_sec == 0 && current.it_interval.tv_nsec == 0) {
    const timespec each{period / 1000, period % 1000 * 1'000'000L};
    const itimerspec times{each, each};
    timerfd_settime(timer_, 0, &times, nullptr);
  }
  while (true) {
    std::array<pollfd, 3> waits = {{{signals_, POLLIN, 0}, {ending_, POLLIN, 0}, {timer_, POLLIN, 0}}};
    if (poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "poll");
    if (waits[1].revents != 0) return Wake::kEnd;
    if (signalfd_siginfo info{}; waits[0].revents != 0 && read(signals_, &info, sizeof(info)) == sizeof(info))
      return info.ssi_signo == SIGHUP ? Wake::kReload : Wake::kEnd;
    if (uint64_t ticks = 0; waits[2].revents != 0 && read(timer_, &ticks, sizeof(ticks)) == sizeof(ticks))
      return Wake::kTick;
  }
}

void Signals::end() { eventfd_write(ending_, 1); }

}  // namespace edgepose
