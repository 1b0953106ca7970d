#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace edgepose {

/// How a loop keeps its time.
struct RealTime {
  int priority = 50;   ///< of SCHED_FIFO, 1 to 99; 0: none
  int processors = 2;  ///< 1 to 64; of which whichever is awake first runs its cycle
};

/// Makes the calling thread one that the system runs before all others (SCHED_FIFO, 1 to 99). Empty, or what
/// the system refuses: then the thread is as late as the machine is busy.
std::string become_real_time(int priority);

/// The processors that the program may use.
std::vector<size_t> allowed_processors();
/// The calling thread runs there only. Empty, or what the system refuses.
std::string stay_on(size_t processor);

/// Keeps the program's memory from being paged out. May take a tenth of a second. Empty, or what the system
/// refuses.
std::string lock_memory();

}  // namespace edgepose
