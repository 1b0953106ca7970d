#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

namespace edgepose {

/// How long after their deadlines cycles began and ended, as counts in bins of 10 us. One thread adds; any
/// reads.
class CycleTimes {
 public:
  static constexpr int64_t kBinNs = 10'000;

  void add(int64_t late_ns, int64_t ended_ns) {
    count(late_, late_ns);
    count(ended_, ended_ns);
    if (late_ns > worst_.load(std::memory_order_relaxed)) worst_.store(late_ns, std::memory_order_relaxed);
  }
  void add_missed(int64_t late_ns) {
    missed_.fetch_add(1, std::memory_order_relaxed);
    count(late_, late_ns);
    count(ended_, late_ns);
  }

  double late(double share) const { return quantile(late_, share); }    ///< [s] upper edge of the bin
  double ended(double share) const { return quantile(ended_, share); }  ///< [s] SYNC and set points are out
  double worst_late() const { return 1e-9 * static_cast<double>(worst_.load(std::memory_order_relaxed)); }
  uint64_t cycles() const;  ///< with those that were missed
  uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }  ///< left out, being late

 private:
  static constexpr size_t kBins = 2001;  // the last holds all above 20 ms
  using Bins = std::array<std::atomic<uint32_t>, kBins>;
  static void count(Bins& bins, int64_t ns) {
    const int64_t bin = ns < 0 ? 0 : ns / kBinNs;
    bins[bin < static_cast<int64_t>(kBins) ? static_cast<size_t>(bin) : kBins - 1].fetch_add(
        1, std::memory_order_relaxed);
  }
  static double quantile(const Bins& bins, double share);

  Bins late_{}, ended_{};
  std::atomic<int64_t> worst_ = 0;
  std::atomic<uint64_t> missed_ = 0;
};

/// Deadlines a period apart on the steady clock, for threads on several processors: whichever is awake first
/// does the work of a cycle, so that a processor that sleeps, or that a host has given to others, does not
/// make it late. Deadlines that were missed are left out, never made up for in a burst.
class CycleClock {
 public:
  explicit CycleClock(int64_t period_ns) : period_ns_(period_ns) {}

  /// The first deadline is a period from now. Before any thread sleeps.
  void begin();

  /// A thread's own sleep.
  class Sleeper {
   public:
    explicit Sleeper(CycleClock& clock) : clock_(clock) {}
    /// Sleeps until the next deadline. Returns it [ns] if this thread is to do the work, alone until it calls
    /// done(); nothing if another does or has done it.
    std::optional<int64_t> wait();

   private:
    CycleClock& clock_;
    int64_t slept_until_ns_ = 0;
  };

  /// The cycle's work is done. Deadlines that went by meanwhile count as late ones, too.
  void done(CycleTimes& times);

 private:
  const int64_t period_ns_;
  std::mutex working_;
  std::atomic<int64_t> next_ns_ = 0;
};

}  // namespace edgepose
