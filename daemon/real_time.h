#pragma once
#include <string>

namespace edgepose {

/// Makes the calling thread one that the system runs before all others (SCHED_FIFO, 1 to 99). Empty, or what
/// the system refuses: then the thread is as late as the machine is busy.
std::string become_real_time(int priority);

/// Keeps the program's memory from being paged out. May take a tenth of a second. Empty, or what the system
/// refuses.
std::string lock_memory();

}  // namespace edgepose
