#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <vector>

namespace edgepose {

/// The last 1000 of some durations, for their quantiles, and all of them in a histogram. Seconds. Safe from
/// any thread; memory does not grow.
class Recent {
 public:
  /// Upper ends of the histogram's buckets [s]; the last bucket is open.
  static constexpr std::array<double, 12> kBuckets = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05,
                                                      0.1,   0.2,   0.5,   1,    2,    5};
  struct Histogram {
    std::array<uint64_t, kBuckets.size()> at_most{};  ///< how many took no longer than the bucket's end
    uint64_t count = 0;
    double sum = 0;
  };

  void add(double seconds) {
    const std::scoped_lock lock(mutex_);
    if (last_.size() < kKept) {
      last_.push_back(seconds);
    } else {
      last_[histogram_.count % kKept] = seconds;
    }
    for (size_t i = 0; i < kBuckets.size(); ++i) histogram_.at_most[i] += seconds <= kBuckets[i];
    ++histogram_.count;
    histogram_.sum += seconds;
  }
  /// `share` in [0, 1]: 0.5 is the median. 0 before the first.
  double quantile(double share) const {
    std::vector<double> sorted;
    {
      const std::scoped_lock lock(mutex_);
      sorted = last_;
    }
    if (sorted.empty()) return 0;
    const auto at = sorted.begin() + std::lround(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
  }
  Histogram histogram() const {
    const std::scoped_lock lock(mutex_);
    return histogram_;
  }

 private:
  static constexpr size_t kKept = 1000;
  mutable std::mutex mutex_;
  std::vector<double> last_;
  Histogram histogram_;
};

}  // namespace edgepose
