#include "tests/lateness.h"

#include <pthread.h>
#include <time.h>

#include <algorithm>

namespace edgepose::test {
namespace {

constexpr int64_t kPeriod = 5'000'000, kSecond = 1'000'000'000;  // [ns]

int64_t steady() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

}  // namespace

Lateness::Lateness(int64_t& worst_ns) {
  thread_ = std::thread([this, &worst_ns] {
    for (int64_t next = steady(); !ending_;) {
      next += kPeriod;
      const timespec until{next / kSecond, next % kSecond};
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
      const int64_t now = steady();
      worst_ns = std::max(worst_ns, now - next);
      next = now;
    }
  });
  const sched_param first{.sched_priority = 90};
  pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &first);  // where it may
}

Lateness::~Lateness() {
  ending_ = true;
  thread_.join();
}

}  // namespace edgepose::test
