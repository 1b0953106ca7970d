#pragma once

namespace edgepose {

/// Tells glibc to keep what is freed instead of giving it back to the system: every image needs the same ten
/// megabytes again, and pages that come anew cost a third of the preprocessing. Two arenas at most, so that
/// memory does not creep up with the number of threads. To be called first in main(); does nothing with
/// another C library.
void keep_freed_memory();

}  // namespace edgepose
