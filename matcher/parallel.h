#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

#include "matcher/worker_pool.h"

namespace edgepose {

/// 0 = all cores, else as asked (at most 256).
inline int thread_count(int requested) {
  if (requested > 0) return std::min(requested, 256);
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls work(i) for i in [0, count) on `threads` threads. Which thread takes which i is open, so work(i)
/// must write only what belongs to i: then the result is the same bits at any thread count.
/// The first exception is thrown again in the calling thread.
template <typename Work>
void parallel_for(size_t count, int threads, const Work& work) {
  const size_t workers = std::min<size_t>(static_cast<size_t>(thread_count(threads)), count);
  if (workers <= 1) {
    for (size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  auto run = [&] {
    try {
      for (size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  WorkerPool::instance().run(
      workers - 1, [](void* job) { (*static_cast<decltype(run)*>(job))(); }, &run);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace edgepose
