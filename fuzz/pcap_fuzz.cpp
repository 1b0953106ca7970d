#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "bus/pcap_reader.h"
#include "fuzz/input_check.h"

// The reader works on files: one in memory.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  static const int file = memfd_create("pcap", 0);
  must_hold(file >= 0 && ftruncate(file, static_cast<off_t>(size)) == 0);
  must_hold(pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
  reads([&] {
    PcapReader reader("/proc/self/fd/" + std::to_string(file));
    uint64_t frames = 0;
    for (Received read; (read = reader.next()).kind != Received::Kind::kNothing; ++frames) {
      must_hold(read.frame.size <= 8 && read.frame.id <= CanFrame::kMaxId && read.frame.time_ns >= 0);
      must_hold(read.kind != Received::Kind::kEvent || read.event != BusEvent::kNone);
    }
    must_hold(24 + 16 * (frames + reader.skipped()) <= size);
  });
  return 0;
}
