#include "tests/lateness.h"

#include <algorithm>

#include "bus/steady_clock.h"
#include "daemon/real_time.h"

namespace edgepose::test {
namespace {

constexpr int64_t kPeriod = 5'000'000;  // [ns]
constexpr int kFirst = 90;              // priority

}  // namespace

Lateness::Lateness(int64_t& worst_ns) : worst_ns_(worst_ns) {
  for (const size_t processor : allowed_processors())
    threads_.emplace_back([this, processor] { watch(processor); });
}

Lateness::~Lateness() {
  ending_ = true;
  for (std::thread& thread : threads_) thread.join();
  worst_ns_ = std::max<int64_t>(worst_ns_, latest_ns_);
}

void Lateness::watch(size_t processor) {
  if (!stay_on(processor).empty() || !become_real_time(kFirst).empty()) return;
  for (int64_t next = steady_ns(); !ending_;) {
    next += kPeriod;
    sleep_until(next);
    const int64_t now = steady_ns();
    for (int64_t latest = latest_ns_; now - next > latest;)
      if (latest_ns_.compare_exchange_weak(latest, now - next)) break;
    next = now;
  }
}

}  // namespace edgepose::test
