#include "common/keep_memory.h"

#include <cstdlib>  // says which C library it is
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace edgepose {

void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int kLargestKept = 32 << 20, kKept = 128 << 20;  // bytes; glibc takes no more for the first
  mallopt(M_ARENA_MAX, 2);
  mallopt(M_MMAP_THRESHOLD, kLargestKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
#endif
}

}  // namespace edgepose
