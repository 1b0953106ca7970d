#pragma once
#include <csignal>
#include <optional>
#include <stop_token>
#include <thread>

#include "client/service/clock.h"

namespace edgepose {

/// As long as it lives, Ctrl-C (SIGINT), SIGTERM and SIGHUP ask for a stop instead of ending the program; a
/// second one ends it at once. Signals that are ignored (nohup) stay so. Make it before other threads: they
/// inherit that the signals are blocked.
class StopSignals {
 public:
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  std::stop_token token() const { return source_.get_token(); }

 private:
  void wait();

  sigset_t signals_{}, before_{};
  int descriptor_ = -1, wake_ = -1;
  std::stop_source source_;
  std::thread thread_;
};

/// Waits until then. False if a stop was asked for, at once.
bool wait_until(SteadyTime when, const std::stop_token& stop);

/// Deadlines at a fixed rate from the start on, so that no delay adds up. What was missed by more than a
/// period is left out, not made up for in a burst.
class Pacer {
 public:
  /// `rate`: [Hz] > 0.
  explicit Pacer(double rate) : period_(1 / rate) {}

  /// Waits for the next deadline; the first is at once. False if a stop was asked for.
  bool wait(const std::stop_token& stop);
  uint64_t missed() const { return missed_; }

 private:
  double period_;  // [s]
  std::optional<SteadyTime> start_;
  uint64_t next_ = 0, missed_ = 0;
};

}  // namespace edgepose
