#pragma once
#include <atomic>
#include <cstdint>
#include <thread>

namespace edgepose::test {

/// How late the machine lets run who comes before all others: what it misses as a whole, whatever the
/// programs on it do. Left in `worst_ns` at the end.
class Lateness {
 public:
  explicit Lateness(int64_t& worst_ns);
  Lateness(const Lateness&) = delete;
  Lateness& operator=(const Lateness&) = delete;
  ~Lateness();

 private:
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace edgepose::test
