#include "matcher/worker_pool.h"

#include <exception>
#include <thread>

namespace edgepose {
namespace {

constexpr uint64_t kOneJob = uint64_t{1} << 32, kOnePlace = uint64_t{1} << 16;
constexpr int kSpins = 2000;  // about 20 us: stages follow each other closely, and waking up takes longer

uint64_t places(uint64_t gate) { return gate >> 16 & 0xffff; }
uint64_t begun(uint64_t gate) { return gate & 0xffff; }

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

WorkerPool& WorkerPool::instance() {
  static WorkerPool* pool = new WorkerPool;  // never deleted: its threads may outlive main()'s end
  return *pool;
}

void WorkerPool::run(size_t helpers, void (*job)(void*), void* context) {
  if (helpers == 0 || busy_.exchange(true)) return job(context);
  add_workers(helpers);
  job_ = job;
  context_ = context;
  ended_.store(0);
  const uint64_t number = gate_.load() / kOneJob + 1;
  gate_.store(number * kOneJob + helpers * kOnePlace);
  gate_.notify_all();
  job(context);
  const uint64_t last = gate_.fetch_and(~(uint64_t{0xffff} << 16));  // nobody begins from here on
  const auto all = static_cast<uint32_t>(begun(last));
  for (int i = 0; i < kSpins && ended_.load() != all; ++i) pause();
  for (uint32_t ended = ended_.load(); ended != all; ended = ended_.load()) ended_.wait(ended);
  busy_.store(false);
}

void WorkerPool::add_workers(size_t wanted) {
  try {
    for (; workers_ < wanted; ++workers_) std::thread([this] { work(); }).detach();
  } catch (const std::exception&) {
    // The system has no more threads: those that there are do the work.
  }
}

uint64_t WorkerPool::wait_for_job(uint64_t seen) const {
  for (;;) {
    uint64_t gate = gate_.load();
    for (int i = 0; i < kSpins && (gate / kOneJob == seen || places(gate) == 0); ++i) {
      pause();
      gate = gate_.load();
    }
    if (gate / kOneJob != seen && places(gate) > 0) return gate;
    gate_.wait(gate);
  }
}

void WorkerPool::work() {
  uint64_t seen = 0;
  for (;;) {
    uint64_t gate = wait_for_job(seen);
    seen = gate / kOneJob;
    // Take a place, unless the job ends meanwhile or others have taken them all.
    bool mine = false;
    while (gate / kOneJob == seen && places(gate) > 0 && !mine)
      mine = gate_.compare_exchange_weak(gate, gate - kOnePlace + 1);
    if (!mine) continue;
    job_(context_);
    ended_.fetch_add(1);
    ended_.notify_one();
  }
}

}  // namespace edgepose
