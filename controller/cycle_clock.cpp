#include "controller/cycle_clock.h"

#include <time.h>

#include <cerrno>

#include "bus/steady_clock.h"

namespace edgepose {

double CycleTimes::quantile(const Bins& bins, double share) {
  uint64_t all = 0;
  for (const auto& bin : bins) all += bin.load(std::memory_order_relaxed);
  const double wanted = share * static_cast<double>(all);
  double seen = 0;
  for (size_t i = 0; i < bins.size(); ++i) {
    seen += bins[i].load(std::memory_order_relaxed);
    if (seen >= wanted && seen > 0) return 1e-9 * static_cast<double>((i + 1) * kBinNs);
  }
  return 0;
}

uint64_t CycleTimes::cycles() const {
  uint64_t all = 0;
  for (const auto& bin : late_) all += bin.load(std::memory_order_relaxed);
  return all;
}

int64_t CycleClock::wait(CycleTimes& times) {
  const int64_t now = steady_ns();
  next_ns_ = next_ns_ == 0 ? now + period_ns_ : next_ns_ + period_ns_;
  if (now > next_ns_) {
    const int64_t missed = (now - next_ns_) / period_ns_ + 1;
    times.add_missed(static_cast<uint64_t>(missed));
    next_ns_ += missed * period_ns_;
  }
  timespec until{next_ns_ / 1'000'000'000, next_ns_ % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  return next_ns_;
}

}  // namespace edgepose
