#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace edgepose {

/// Threads that wait for work: a stage takes a millisecond, and starting a thread for it a tenth of that and
/// more. They are made when first asked for and live as long as the process.
class WorkerPool {
 public:
  static WorkerPool& instance();

  /// Runs job(context) in the calling thread and at the same time in up to `helpers` others, and returns when
  /// all that began have ended. A helper that comes too late, when the caller has ended, does not begin: the
  /// job must not count on any. If the pool works for another thread already, only the caller runs it.
  void run(size_t helpers, void (*job)(void*), void* context);

 private:
  WorkerPool() = default;
  void add_workers(size_t wanted);
  void work();
  uint64_t wait_for_job(uint64_t seen) const;

  std::atomic<bool> busy_{false};  // works for a thread; what that one's job runs in parallel, it runs alone
  size_t workers_ = 0;
  // Of the job that is offered; written only while the gate is closed.
  void (*job_)(void*) = nullptr;
  void* context_ = nullptr;
  // Number of the job << 32 | helpers that may still begin << 16 | helpers that have begun.
  std::atomic<uint64_t> gate_{0};
  std::atomic<uint32_t> ended_{0};
};

}  // namespace edgepose
