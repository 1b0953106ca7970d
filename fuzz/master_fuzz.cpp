#include <cmath>

#include "canopen/master.h"
#include "fuzz/sink_bus.h"

// Frames to a master, cycle after cycle, whatever it is doing.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  SinkBus bus(data, size);
  Master master(bus, {});
  int64_t now = 1'000'000'000;
  must_hold(master.set_up(now));
  PerAxis<double> set_points{};
  for (int i = 0; i < 2000 && !bus.is_empty(); ++i, now += 5'000'000) {
    const ArmState& state = master.cycle(now, set_points);
    must_hold((state.phase == MasterPhase::kFault) == static_cast<bool>(master.fault()));
    must_hold(master.fault_text().find('\n') == std::string::npos);
    for (size_t axis = 0; axis < set_points.size(); ++axis) {
      must_hold(std::isfinite(state.axes[axis].position) && std::isfinite(state.axes[axis].velocity));
      set_points[axis] = state.axes[axis].position;
    }
    if (state.phase == MasterPhase::kReady) master.enable(now);
    if (state.phase == MasterPhase::kFault && i % 50 == 0) master.reset(now);
  }
  return 0;
}
