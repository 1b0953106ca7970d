#include "daemon/keep_awake.h"

#include <pthread.h>
#include <sched.h>

namespace edgepose {
namespace {

/// Only if the thread then really gives way: a machine without this would have lost a processor.
bool give_way_on(size_t processor) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(processor, &only);
  const sched_param none{};
  return pthread_setaffinity_np(pthread_self(), sizeof only, &only) == 0 &&
         pthread_setschedparam(pthread_self(), SCHED_IDLE, &none) == 0;
}

}  // namespace

KeepAwake::KeepAwake() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  for (size_t processor = 0; processor < CPU_SETSIZE; ++processor)
    if (CPU_ISSET(processor, &allowed))
      threads_.emplace_back([this, processor] {
        if (!give_way_on(processor)) return;
        // No pause instruction: a host takes it for a sign that the processor can be given away.
        while (!ending_.load(std::memory_order_relaxed)) {
        }
      });
}

KeepAwake::~KeepAwake() {
  ending_ = true;
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace edgepose
