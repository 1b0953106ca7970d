#include "controller/cycle_clock.h"

#include <algorithm>

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

void CycleClock::begin() { next_ns_ = steady_ns() + period_ns_; }

std::optional<int64_t> CycleClock::Sleeper::wait() {
  // While another works on a deadline, it is still the next.
  slept_until_ns_ = std::max(clock_.next_ns_.load(), slept_until_ns_ + clock_.period_ns_);
  sleep_until(slept_until_ns_);
  // Most often it has been worked on; only who may be the first goes for the lock.
  if (clock_.next_ns_ > slept_until_ns_ || !clock_.working_.try_lock()) return std::nullopt;
  const int64_t next = clock_.next_ns_;
  if (next <= slept_until_ns_) return next;
  clock_.working_.unlock();
  return std::nullopt;
}

void CycleClock::done(CycleTimes& times) {
  int64_t next = next_ns_ + period_ns_;
  for (const int64_t now = steady_ns(); next < now; next += period_ns_) times.add_missed(now - next);
  next_ns_ = next;
  working_.unlock();
}

}  // namespace edgepose
