#pragma once
#include <cstdint>

namespace edgepose {

/// What /proc/self tells; zeros where it does not.
struct MemoryUse {
  uint64_t resident_bytes = 0;
  int threads = 0;
  uint64_t open_files = 0;
};
MemoryUse memory_use();

}  // namespace edgepose
