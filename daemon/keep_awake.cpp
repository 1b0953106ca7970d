#include "daemon/keep_awake.h"

#include <pthread.h>
#include <sched.h>

#include <system_error>

#include "daemon/real_time.h"

namespace edgepose {
namespace {

/// Only if the thread then really gives way: a machine without this would have lost a processor.
bool give_way() {
  const sched_param none{};
  return pthread_setschedparam(pthread_self(), SCHED_IDLE, &none) == 0;
}

}  // namespace

KeepAwake::KeepAwake() {
  const auto stay_awake = [this](size_t processor) {
    if (!stay_on(processor).empty() || !give_way()) return;
    // No pause instruction: a host takes it for a sign that the processor can be given away.
    while (!ending_.load(std::memory_order_relaxed)) {
    }
  };
  try {
    for (const size_t processor : allowed_processors()) threads_.emplace_back(stay_awake, processor);
  } catch (const std::system_error&) {  // no more threads: those that there are do
  }
}

KeepAwake::~KeepAwake() {
  ending_ = true;
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace edgepose
