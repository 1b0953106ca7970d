#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace edgepose::test {

/// How late the machine lets run who comes before all others: what it misses as a whole, whatever the
/// programs on it do. The latest of its processors, left in `worst_ns` at the end; 0 where the system allows
/// no such priority (SCHED_FIFO): nothing is known then, and nothing is excused.
class Lateness {
 public:
  explicit Lateness(int64_t& worst_ns);
  Lateness(const Lateness&) = delete;
  Lateness& operator=(const Lateness&) = delete;
  ~Lateness();

 private:
  void watch(size_t processor);

  int64_t& worst_ns_;
  std::atomic<int64_t> latest_ns_ = 0;
  std::atomic<bool> ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace edgepose::test
