#include "daemon/real_time.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>

namespace edgepose {

std::string become_real_time(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (const int fault = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters); fault != 0)
    return std::string("SCHED_FIFO: ") + std::strerror(fault);
  return "";
}

std::string lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) return std::string("mlockall: ") + std::strerror(errno);
  return "";
}

}  // namespace edgepose
