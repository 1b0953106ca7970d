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

std::vector<size_t> allowed_processors() {
  cpu_set_t allowed;
  std::vector<size_t> processors;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return processors;
  for (size_t i = 0; i < CPU_SETSIZE; ++i)
    if (CPU_ISSET(i, &allowed)) processors.push_back(i);
  return processors;
}

std::string stay_on(size_t processor) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(processor, &only);
  const int fault = pthread_setaffinity_np(pthread_self(), sizeof only, &only);
  return fault == 0 ? "" : std::string("a thread's processor: ") + std::strerror(fault);
}

std::string lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) return std::string("mlockall: ") + std::strerror(errno);
  return "";
}

}  // namespace edgepose
