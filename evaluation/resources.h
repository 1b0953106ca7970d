#pragma once

namespace edgepose {

/// [MB] largest resident memory of this process so far (VmHWM); 0 if the system does not tell.
double peak_memory_megabytes();

/// [s] user and system time of this process so far, all threads together.
double process_cpu_seconds();

}  // namespace edgepose
