#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "fuzz/input_check.h"
#include "messaging/lcm_log.h"

// The reader works on files: one in memory.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  static const int file = memfd_create("log", 0);
  must_hold(file >= 0 && ftruncate(file, static_cast<off_t>(size)) == 0);
  must_hold(pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  reads([&] {
    LcmLogReader reader("/proc/self/fd/" + std::to_string(file));
    uint64_t read = 0;
    for (LoggedMessage message; reader.next(message);)
      read += 28 + message.channel.size() + message.data.size();
    must_hold(read + reader.skipped_bytes() <= size);
  });
  return 0;
}
