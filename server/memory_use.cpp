#include "server/memory_use.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace edgepose {

MemoryUse memory_use() {
  MemoryUse use;
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    if (key == "VmRSS:") {
      status >> use.resident_bytes;
      use.resident_bytes *= 1024;
    } else if (key == "Threads:") {
      status >> use.threads;
    }
    status.ignore(1024, '\n');
  }
  std::error_code ignored;
  std::filesystem::directory_iterator file("/proc/self/fd", ignored);
  for (; file != std::filesystem::directory_iterator(); file.increment(ignored)) ++use.open_files;
  return use;
}

}  // namespace edgepose
