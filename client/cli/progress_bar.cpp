#include "client/cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

namespace edgepose {
namespace {

constexpr int kCells = 30;

class Bar {
 public:
  explicit Bar(std::string label) : label_(std::move(label)), start_(Steady::now()) {}
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;
  ~Bar() { erase(); }

  void show(double share) {
    share = std::clamp(share, 0.0, 1.0);
    const int percent = static_cast<int>(share * 100);
    if (share >= 1) return erase();
    if (percent == shown_percent_) return;
    shown_percent_ = percent;
    const int full = static_cast<int>(share * kCells);
    const std::string cells =
        std::string(static_cast<size_t>(full), '#') + std::string(static_cast<size_t>(kCells - full), '.');
    std::fprintf(stderr, "\r\033[K%s [%s] %3d %%%s", label_.c_str(), cells.c_str(), percent,
                 remaining(share).c_str());
    std::fflush(stderr);
  }

 private:
  using Steady = std::chrono::steady_clock;

  /// Guessed from the time so far; nothing while there is little to guess from.
  std::string remaining(double share) const {
    const double elapsed = std::chrono::duration<double>(Steady::now() - start_).count();
    if (share < 0.02 || elapsed < 1) return "";
    return ", " + std::to_string(std::lround(elapsed * (1 - share) / share)) + " s left";
  }

  void erase() {
    if (shown_percent_ < 0) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    shown_percent_ = -1;
  }

  std::string label_;
  Steady::time_point start_;
  int shown_percent_ = -1;
};

class Clock {
 public:
  explicit Clock(std::string label) : label_(std::move(label)) {}
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  ~Clock() { show(-1); }

  void show(double seconds) {
    const int whole = static_cast<int>(seconds);
    if (seconds < 0 && shown_ > 0) std::fputs("\r\033[K", stderr);
    if (seconds >= 0 && whole != shown_ && whole > 0)
      std::fprintf(stderr, "\r\033[K%s: %d s", label_.c_str(), whole);
    shown_ = seconds < 0 ? 0 : whole;
    std::fflush(stderr);
  }

 private:
  std::string label_;
  int shown_ = 0;
};

}  // namespace

std::function<void(double)> progress_bar(const std::string& label) {
  if (isatty(STDERR_FILENO) == 0) return [](double) {};
  return [bar = std::make_shared<Bar>(label)](double share) { bar->show(share); };
}

std::function<void(double)> elapsed_time(const std::string& label) {
  if (isatty(STDERR_FILENO) == 0) return [](double) {};
  return [clock = std::make_shared<Clock>(label)](double seconds) { clock->show(seconds); };
}

}  // namespace edgepose
