#pragma once
#include <atomic>
#include <thread>
#include <vector>

namespace edgepose {

/// Keeps the processors from sleeping when nobody needs them. To wake one takes some 0.1 ms on a machine of
/// its own, and on a virtual one as long as its host lets others run there: milliseconds. On every processor
/// that the program may use a thread runs that gives way to any other (SCHED_IDLE). Costs the power of a
/// machine that works all the time.
class KeepAwake {
 public:
  KeepAwake();
  KeepAwake(const KeepAwake&) = delete;
  KeepAwake& operator=(const KeepAwake&) = delete;
  ~KeepAwake();

 private:
  std::atomic<bool> ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace edgepose
