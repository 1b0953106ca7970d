#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "canopen/master_options.h"

namespace edgepose {

/// One cycle as the master saw it.
struct CycleRecord {
  int64_t time_ns = 0;
  PerAxis<double> target{}, position{};  ///< [rad]
  PerAxis<uint16_t> controlword{}, statusword{};
};

/// The last 50 cycles, so that a fault can be understood afterwards. Allocates only when it is asked for
/// them.
class CycleRing {
 public:
  static constexpr size_t kSize = 50;

  void add(const CycleRecord& record) { records_[count_++ % kSize] = record; }
  void clear() { count_ = 0; }
  /// The oldest first.
  std::vector<CycleRecord> all() const {
    std::vector<CycleRecord> out;
    for (size_t i = count_ > kSize ? count_ - kSize : 0; i < count_; ++i) out.push_back(records_[i % kSize]);
    return out;
  }

 private:
  std::array<CycleRecord, kSize> records_{};
  size_t count_ = 0;
};

}  // namespace edgepose
