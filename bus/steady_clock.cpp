#include "bus/steady_clock.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>

namespace edgepose {

int64_t steady_ns() {
  using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::steady_clock;
  return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

int64_t wall_minus_steady_ns() {
  using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::system_clock;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count() - steady_ns();
}

void sleep_until(int64_t deadline_ns) {
  constexpr int64_t kSecond = 1'000'000'000;
  const timespec until{deadline_ns / kSecond, deadline_ns % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

bool wait_for_input(int descriptor, int64_t deadline_ns) {
  constexpr int64_t kSecond = 1'000'000'000;
  for (;;) {
    const int64_t left = deadline_ns <= 0 ? 0 : std::max<int64_t>(0, deadline_ns - steady_ns());
    const timespec timeout{.tv_sec = left / kSecond, .tv_nsec = left % kSecond};
    pollfd watched{.fd = descriptor, .events = POLLIN, .revents = 0};
    const int ready = ppoll(&watched, 1, &timeout, nullptr);
    if (ready > 0) return true;
    if (ready == 0 || left == 0) return false;  // else a signal came: wait on
  }
}

}  // namespace edgepose
