#include <cmath>

#include "canopen/drive.h"
#include "fuzz/sink_bus.h"

// Frames to a simulated drive.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  SinkBus bus(data, size);
  int64_t now = 1'000'000'000;
  Drive drive(bus, {}, now);
  drive.step(now);
  for (int i = 0; i < 2000 && !bus.is_empty(); ++i) {
    now += 1'000'000;
    drive.step(now);
    must_hold(std::isfinite(drive.position()) && std::isfinite(drive.velocity()));
    must_hold(drive.objects().value(object::kVendor) == DriveIdentity{}.vendor);
  }
  return 0;
}
