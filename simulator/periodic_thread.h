#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace edgepose {

/// Calls `work` at fixed deadlines on a thread of its own until it is destroyed. Deadlines that passed while
/// it was at work are left out. `work` must not throw.
class PeriodicThread {
 public:
  PeriodicThread(std::chrono::nanoseconds period, std::function<void()> work)
      : period_(period), work_(std::move(work)), thread_([this] { run(); }) {}
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;
  ~PeriodicThread() {
    {
      const std::scoped_lock lock(mutex_);
      ending_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }

 private:
  void run() {
    auto next = std::chrono::steady_clock::now();
    for (std::unique_lock lock(mutex_); !changed_.wait_until(lock, next, [this] { return ending_; });) {
      lock.unlock();
      work_();
      const auto now = std::chrono::steady_clock::now();
      next += period_ * (1 + (now > next ? (now - next) / period_ : 0));
      lock.lock();
    }
  }

  const std::chrono::nanoseconds period_;
  const std::function<void()> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace edgepose
