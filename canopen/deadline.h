#pragma once
#include <cstdint>

namespace edgepose {

/// Watches that something comes at least every so often, from its first coming on. Says once that it stayed
/// away, and watches again when it has come back.
class Deadline {
 public:
  void feed(int64_t now_ns) { last_ns_ = now_ns, armed_ = true; }
  void disarm() { armed_ = false; }
  /// True once if more than `period_ns` have passed; a period of 0 watches nothing.
  bool expires(int64_t now_ns, int64_t period_ns) {
    if (!armed_ || period_ns <= 0 || now_ns - last_ns_ <= period_ns) return false;
    armed_ = false;
    return true;
  }

 private:
  int64_t last_ns_ = 0;
  bool armed_ = false;
};

}  // namespace edgepose
